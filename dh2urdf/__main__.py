"""``python -m dh2urdf`` is the command line."""

from dh2urdf.cli import main

if __name__ == "__main__":
    main()
