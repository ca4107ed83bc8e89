"""The command line: `python -m alhazen` is the command `alhazen` that is installed with the package."""

from __future__ import annotations

import sys

from . import _alhazen


def main() -> int:
    """Runs the program with the arguments of this one, and returns its exit code."""
    return _alhazen._main(["alhazen", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
