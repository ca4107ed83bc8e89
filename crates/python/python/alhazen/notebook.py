"""Pictures in notebooks."""

from __future__ import annotations

from collections.abc import Callable

from ._alhazen import Image

__all__ = ["live"]


def live(*, view: str = "standard", exposure: float = 0.0) -> Callable[[Image], None]:
    """What shows a render in a notebook while it goes on: `alhazen.render(scene, preview=live())`.

    Each picture replaces the one before it. view, exposure: as those of Image.write().
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
