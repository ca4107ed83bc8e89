"""Progress as a line of text."""

from __future__ import annotations

import sys
import time as clock
from typing import Any

__all__ = ["Bar"]

#: Seconds between two changes of a line that is rewritten, and characters of its bar.
INTERVAL, WIDTH = 0.1, 24


class Bar:
    """The bar of progress=True: passes or shards done, and the time left.

    In a terminal and in a notebook the line is rewritten; in a file there is a line for each tenth.

    time, noise: the limits of the render, by which the time left is estimated, too.
    """

    def __init__(self, time: float | None = None, noise: float | None = None) -> None:
        self.time, self.noise = time, noise
        self.rewrites = sys.stderr is not None and (sys.stderr.isatty() or "ipykernel" in sys.modules)
        self.shown_at, self.shown_part = -INTERVAL, -1
        self.last = self.written = ""

    def __call__(self, progress: Any) -> None:
        part, text = self._describe(progress)
        self.last = text
        now = clock.monotonic()
        is_due = now - self.shown_at >= INTERVAL if self.rewrites else int(10 * part) > self.shown_part
        if is_due:
            self.shown_at, self.shown_part = now, int(10 * part)
            self._write(text)

    def close(self) -> None:
        """Shows the last state, and ends the line."""
        if self.last:
            self._write(self.last)
        if self.rewrites and self.written:
            print(file=sys.stderr, flush=True)

    def _describe(self, progress: Any) -> tuple[float, str]:
        """The part that is done, and the line."""
        # A cluster counts shards.
        unit = "shards" if hasattr(progress, "shards") else "passes"
        done, total, seconds = getattr(progress, unit), progress.total, progress.seconds
        left = []
        if total is not None and done:
            left.append(seconds * (total - done) / done)
        if self.time is not None:
            left.append(max(self.time - seconds, 0.0))
        noise = getattr(progress, "noise", None)
        if self.noise is not None and noise is not None:
            # Noise falls with the square root of the time.
            left.append(max((noise / self.noise) ** 2 - 1, 0.0) * seconds)
        least = min(left, default=None)
        part = 0.0 if least is None or seconds + least == 0 else seconds / (seconds + least)
        filled = round(WIDTH * part)
        bar = "#" * filled + "-" * (WIDTH - filled)
        of = f"{done}/{total}" if total is not None else f"{done}"
        ahead = "" if least is None else f", {_duration(least)} left"
        return part, f"[{bar}] {of} {unit}, {_duration(seconds)}{ahead}"

    def _write(self, text: str) -> None:
        if self.rewrites:
            print("\r" + text.ljust(len(self.written)), end="", file=sys.stderr, flush=True)
        elif text != self.written and sys.stderr is not None:
            print(text, file=sys.stderr, flush=True)
        self.written = text


def _duration(seconds: float) -> str:
    if seconds < 60:
        return f"{seconds:.1f} s" if seconds < 10 else f"{seconds:.0f} s"
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {seconds} s"
