"""`python -m wetdoublet` is the command `wetdoublet`."""

from wetdoublet.solvers.commands.cli import main

if __name__ == "__main__":
    main()
