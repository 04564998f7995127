"""`python -m wetdoublet.solvers` is the command `wetdoublet`."""

from .commands.cli import main

if __name__ == "__main__":
    main()
