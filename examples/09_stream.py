"""A character frame by frame, as a game's loop wants it; the goal may change while it walks.

python examples/09_stream.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    character = motionrt.Runtime(threads=1).stream(motionrt.Goal(0.0, 3.0))
    frames = [next(character) for _ in range(60)]
    frames.append(character.send(motionrt.Goal(3.0, 3.0)))  # somewhere else, from now on
    frames += [next(character) for _ in range(60)]
    x, _, z = frames[-1].root[-1]
    print(f"after {len(frames)} frames at ({x:.1f}, {z:.1f}) m; examples/game_loop.py runs this beside a game")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
