"""``python -m penink_cli`` is the ``penink`` command."""

from penink_cli.main import main

if __name__ == "__main__":
    main()
