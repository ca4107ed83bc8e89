"""The command line: `python -m alhazen` is the program `alhazen` that is installed with the package."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

NAME = "alhazen.exe" if os.name == "nt" else "alhazen"


def program() -> Path:
    """The program: beside the package where that was put into a folder, or among the scripts of the
    environment or of the user."""
    user = sysconfig.get_preferred_scheme("user")
    folders = [
        Path(__file__).parents[1] / "bin",
        Path(sysconfig.get_path("scripts")),
        Path(sysconfig.get_path("scripts", user)),
    ]
    for folder in folders:
        if (folder / NAME).is_file():
            return folder / NAME
    sys.exit(f"error: the program {NAME} is in none of {', '.join(map(str, folders))}")


def main() -> int:
    """Runs the program with the arguments of this one, and returns its exit code."""
    command = [program(), *sys.argv[1:]]
    if os.name == "nt":
        return subprocess.call(command)
    os.execv(command[0], command)


if __name__ == "__main__":
    sys.exit(main())
