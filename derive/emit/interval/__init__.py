"""C for enclosures: the recurrences of the kernel over intervals, with derivatives by the states and by the inputs."""
