"""Pictures shown in notebooks and in the viewer of the system."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable

from ._alhazen import Image

__all__ = ["live", "show"]


def live(*, view: str = "standard", exposure: float = 0.0) -> Callable[[Image], None]:
    """What shows a render in a notebook while it goes on: `alhazen.render(scene, preview=live())`.

    Each picture replaces the one before it.

    view, exposure: as those of Image.write().
    """
    from IPython.display import Image as Shown, display

    shown = None

    def show(image: Image) -> None:
        nonlocal shown
        picture = Shown(image.png(view=view, exposure=exposure))
        if shown is None:
            shown = display(picture, display_id=True)
        else:
            shown.update(picture)

    return show


def show(png: bytes) -> None:
    """Shows a PNG file: below the cell of a notebook, else in the viewer of the system.

    png: the bytes of the file.
    """
    if "ipykernel" in sys.modules:
        from IPython.display import Image as Shown, display

        display(Shown(png))
        return
    # The viewer may read the file at any time later.
    with tempfile.NamedTemporaryFile(prefix="alhazen-", suffix=".png", delete=False) as file:
        file.write(png)
    if sys.platform == "win32":
        os.startfile(file.name)
        return
    viewer = shutil.which("open" if sys.platform == "darwin" else "xdg-open")
    if viewer is None:
        raise RuntimeError(f"there is no xdg-open, which would show {file.name}")
    subprocess.Popen([viewer, file.name], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
