"""The machine and the process: cores, compiler, cache, threads, files."""
