"""One collision: its outcome by either engine, as text and as a figure; in space for any velocities and spins."""
