"""What a window begins with, from files."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.formats import Character, load_character
from motionrt.motion import SMPL24, Motion
from motionrt.studio.bodies import VERTICES
from motionrt.studio.clips import load_clips
from motionrt.studio.draft import Draft
from motionrt.studio.layout import AS_RECORDED, LAYOUTS, SIDE_BY_SIDE
from motionrt.studio.scenery import open_scenery
from motionrt.studio.windows import Show


def show_of(
    clips: Sequence[Path],
    *,
    scene: Path | None = None,
    path: Path | None = None,
    layout: str | None = None,
    character: Path | None = None,
) -> Show:
    """Read everything that is to be shown.

    Args:
        clips: motion files; those that cannot be read are told of in ``problems``, as long as one can.
        scene: a mesh, a map or a script; the keypoints and paths of a script are drawn, too.
        path: CSV of x and z.
        layout: of :data:`motionrt.studio.layout.LAYOUTS`; by default as recorded where there is a scene, a path or only
            one clip, else side by side.
        character: a GLB or VRM with its mesh: who is seen instead of the figure.

    Raises:
        RigError: the character is no humanoid.
        InvalidInputError: no clip can be read, or the layout is unknown.
        ScriptError, SceneError, FormatError, MotionFileNotFoundError: scene or path cannot be read.
    """
    from motionrt.locomotion import Path as GroundPath

    chosen = None if layout is None else checked_layout(layout)
    loaded, problems = load_clips(clips)
    scenery, script = (None, None) if scene is None else open_scenery(scene)
    draft = None if script is None else Draft(script.start, tuple(script.steps))
    alone = len(loaded) < 2 or scenery is not None or path is not None
    return Show(
        clips=loaded,
        problems=problems,
        scenery=scenery,
        draft=draft,
        path=None if path is None else GroundPath.from_csv(path).points,
        layout=chosen or (AS_RECORDED if alone else SIDE_BY_SIDE),
        character=None if character is None else checked_character(character),
    )


def checked_character(file: Path) -> Character:
    """A character that can be shown.

    Raises:
        RigError: it is no humanoid.
        InvalidInputError, FormatError, MotionFileNotFoundError: it cannot be read, or has too many vertices.
    """
    found = load_character(file)
    if len(found.skin.joints) > VERTICES:
        raise InvalidInputError(
            f"{file.name} has {len(found.skin.joints):,} vertices; the page shows {VERTICES:,}: export a simpler mesh"
        )
    still = np.tile(np.eye(3, dtype=np.float32), (2, len(SMPL24.names), 1, 1))
    found.dressed(Motion(still, np.array([[0, 0.95, 0]] * 2, np.float32), 30.0))
    return found


def checked_layout(name: str) -> str:
    """A layout by its name; hyphens count as blanks."""
    plain = name.strip().lower().replace("-", " ").replace("_", " ")
    if plain not in LAYOUTS:
        near = get_close_matches(plain, LAYOUTS, n=1)
        hint = f"did you mean '{near[0]}'?" if near else f"there are: {', '.join(LAYOUTS)}"
        raise InvalidInputError(f"unknown layout '{name}'; {hint}")
    return plain
