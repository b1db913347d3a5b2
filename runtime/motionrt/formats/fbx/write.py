"""FBX out, through Blender's exporter: there is no other free writer that game engines and MotionBuilder read well.

The motion goes to Blender as a GLB. Nothing of the names of files becomes part of a program: they are arguments.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from motionrt.errors import InvalidInputError, MissingDependencyError
from motionrt.formats.atomic import write_bytes
from motionrt.formats.gltf.write import write_glb
from motionrt.motion.motion import Motion

PROGRAM = "MOTIONRT_BLENDER"
"""Environment variable that names the program, if it is not ``blender``."""

_PATIENCE_S = 300
_ERROR = re.compile(r"[\w.]*(Error|Exception): ")
_SCRIPT = """
import sys, bpy, numpy
source, target, fps = sys.argv[sys.argv.index("--") + 1:]
if not hasattr(numpy, "bool"): numpy.bool = bool  # as the importer of Blender 3 calls it
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = max(1, round(float(fps)))
bpy.ops.import_scene.gltf(filepath=source)
scene.render.fps_base = scene.render.fps / float(fps)
animated = [thing.animation_data for thing in scene.objects if thing.animation_data]
ends = [data.action.frame_range for data in animated if data.action] or [(0, 0)]
scene.frame_start, scene.frame_end = round(min(e[0] for e in ends)), round(max(e[1] for e in ends))
bpy.ops.export_scene.fbx(filepath=target, add_leaf_bones=False, bake_anim_use_nla_strips=False,
    bake_anim_use_all_actions=False, bake_anim_simplify_factor=0.0)
"""


def can_write_fbx() -> bool:
    """Whether there is a Blender."""
    return _blender() is not None


def _blender() -> str | None:
    return shutil.which(os.environ.get(PROGRAM, "blender"))


def write_fbx(motion: Motion, path: str | Path) -> Path:
    """Write a motion as binary FBX, whole or not at all: skeleton, animation and the body of bones of a GLB.

    Raises:
        MissingDependencyError: there is no Blender.
        InvalidInputError: the file cannot be written.
    """
    return fbx_of_glb(path, motion.fps, lambda glb, fps: write_glb(replace(motion, fps=fps), glb))


def fbx_of_glb(path: str | Path, fps: float, write: Callable[[Path, float], Path]) -> Path:
    """Let Blender write as FBX what ``write`` writes into a GLB of that name and rate; errors as :func:`write_fbx`.

    Frames of Blender are whole numbers at a whole rate: the GLB has the nearest one, and the FBX is told ``fps``.
    """
    with tempfile.TemporaryDirectory(prefix="motionrt-") as folder:
        glb = write(Path(folder) / f"{Path(path).stem or 'motion'}.glb", float(max(1, round(fps))))
        out = Path(folder) / "out.fbx"
        _run(Path(path), [str(glb), str(out), repr(float(fps))])
        return write_bytes(path, out.read_bytes())


def _run(path: Path, arguments: list[str]) -> None:
    program = _blender()
    if program is None:
        raise MissingDependencyError(
            f"writing FBX needs Blender 3.4 or newer: install it, or say where it is with {PROGRAM}=PATH;"
            " a .glb or a .bvh needs nothing"
        )
    command = [program, "--background", "--factory-startup", "--python-exit-code", "1", "--python-expr", _SCRIPT, "--"]
    try:
        done = subprocess.run(
            [*command, *arguments], capture_output=True, timeout=_PATIENCE_S, check=False, env=_environment(program)
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise InvalidInputError(f"cannot write {path}: Blender ({program}) does not end well: {error}") from error
    if done.returncode or not Path(arguments[1]).is_file():
        said = _reason((done.stdout + done.stderr).decode(errors="replace"))
        raise InvalidInputError(f"cannot write {path}: Blender ({program}) says: {said}")


def _reason(said: str) -> str:
    """The line of a traceback that names the error, or the last one."""
    lines = said.strip().splitlines() or ["nothing"]
    errors = [line for line in lines if _ERROR.match(line)]
    hint = "; install NumPy for it (Debian: python3-numpy)" if "No module named 'numpy'" in said else ""
    return (errors or lines)[-1] + hint


def _environment(program: str) -> dict[str, str]:
    """That of this process, without its Python: a Blender of a system has the system's."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    places = os.pathsep.join([str(Path(program).resolve().parent), "/usr/bin", kept.get("PATH", "")])
    return {**kept, "PATH": places}
