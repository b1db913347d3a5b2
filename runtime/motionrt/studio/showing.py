"""What a window begins with, from files."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path

from motionrt.errors import InvalidInputError
from motionrt.studio.clips import load_clips
from motionrt.studio.draft import Draft
from motionrt.studio.layout import AS_RECORDED, LAYOUTS, SIDE_BY_SIDE
from motionrt.studio.scenery import open_scenery
from motionrt.studio.windows import Show


def show_of(
    clips: Sequence[Path], *, scene: Path | None = None, path: Path | None = None, layout: str | None = None
) -> Show:
    """Read everything that is to be shown.

    Args:
        clips: motion files; those that cannot be read are told of in ``problems``, as long as one can.
        scene: a mesh, a map or a script; the keypoints and paths of a script are drawn, too.
        path: CSV of x and z.
        layout: of :data:`motionrt.studio.layout.LAYOUTS`; by default as recorded where there is a scene, a path or only
            one clip, else side by side.

    Raises:
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
    )


def checked_layout(name: str) -> str:
    """A layout by its name; hyphens count as blanks."""
    plain = name.strip().lower().replace("-", " ").replace("_", " ")
    if plain not in LAYOUTS:
        near = get_close_matches(plain, LAYOUTS, n=1)
        hint = f"did you mean '{near[0]}'?" if near else f"there are: {', '.join(LAYOUTS)}"
        raise InvalidInputError(f"unknown layout '{name}'; {hint}")
    return plain
