"""What the panel's buttons do. Every operator works without a window, with what it needs as properties."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

import bpy
from bpy.props import FloatProperty, IntProperty, StringProperty

from . import installing, settings

if TYPE_CHECKING:
    from motionrt import Motion, Runtime

_runtime: list[Runtime] = []  # the models stay open between two clicks


def runtime() -> Runtime:
    """The one runtime of this Blender."""
    if not _runtime:
        import motionrt

        _runtime.append(motionrt.Runtime())
    return _runtime[0]


class _Operator:
    """Blender's ``execute`` around :meth:`work`, which returns what to say; errors of motionrt become reports."""

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do it; ``{"CANCELLED"}`` with a report where it cannot be done."""
        try:
            said = self._timed(context)
        except Exception as error:
            if not _expected(error):
                raise
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            # multiprocessing (SciPy uses it) keeps Blender's short-lived __main__, and Blender crashes when it quits
            sys.modules.pop("__mp_main__", None)
        self.report({"INFO"}, said)
        return {"FINISHED"}

    def _timed(self, context: bpy.types.Context) -> str:
        began = time.perf_counter()
        said = self.work(context)
        return f"{said} ({time.perf_counter() - began:.2f} s)"

    def work(self, context: bpy.types.Context) -> str:
        """What the operator is there for."""
        raise NotImplementedError


def _expected(error: Exception) -> bool:
    if isinstance(error, installing.InstallError):
        return True
    import motionrt

    return isinstance(error, motionrt.MotionRTError)


class _NeedsPackage(_Operator):
    """An operator that is grey until motionrt is installed."""

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Whether motionrt is installed."""
        return installing.available()


class MOTIONRT_OT_install(_Operator, bpy.types.Operator):
    """Install the motionrt package for Blender's Python into your user folder (about 400 MB, once)"""

    bl_idname, bl_label = "motionrt.install", "Install motionrt"
    source: StringProperty(name="Package")

    def work(self, _context: bpy.types.Context) -> str:
        """Into the user's folder."""
        installing.install(self.source or settings.source())
        _runtime.clear()
        return f"installed into {installing.folder()}"


class MOTIONRT_OT_search(_NeedsPackage, bpy.types.Operator):
    """Find the clips of the library that fit a text best"""

    bl_idname, bl_label = "motionrt.search", "Search"
    query: StringProperty(name="Text")
    count: IntProperty(name="Hits", default=10, min=1, max=200)

    def work(self, context: bpy.types.Context) -> str:
        """Fill ``scene.motionrt.hits``."""
        chosen = context.scene.motionrt
        found = runtime().retrieve(self.query or chosen.query, k=self.count, gallery=_gallery(context))
        chosen.hits.clear()
        chosen.hit = 0
        for hit in found:
            line = chosen.hits.add()
            line.clip, line.text, line.score = hit.id, hit.text or "", hit.score
            line.start_s, line.end_s = hit.start_s, hit.end_s
        return found.notice or f"{len(found)} clips"


class MOTIONRT_OT_index(_NeedsPackage, bpy.types.Operator):
    """Index the library folder (BVH, GLB, ASF/AMC, AMASS .npz), so that it can be searched; again for what is new"""

    bl_idname, bl_label = "motionrt.index", "Index"

    def work(self, context: bpy.types.Context) -> str:
        """Build or update the gallery of the folder."""
        folder = _gallery(context)
        if folder is None:
            raise installing.InstallError("choose the folder with your motion files first")
        report = runtime().build_gallery(folder)
        return f"{len(report.gallery)} clips, {len(report.gallery.skipped)} files skipped"


class MOTIONRT_OT_apply(_NeedsPackage, bpy.types.Operator):
    """Put the chosen clip onto the active armature, or onto a new one, from the current frame on"""

    bl_idname, bl_label = "motionrt.apply", "Apply to armature"
    bl_options = {"REGISTER", "UNDO"}
    index: IntProperty(name="Hit", default=-1)

    def work(self, context: bpy.types.Context) -> str:
        """The found span of the clip."""
        chosen = context.scene.motionrt
        index = self.index if self.index >= 0 else chosen.hit
        if index >= len(chosen.hits):
            raise installing.InstallError("search first, then choose a hit")
        line = chosen.hits[index]
        gallery = runtime().gallery(_gallery(context))
        motion = gallery.motion(line.clip).between(line.start_s, line.end_s).canonical()
        return _put(context, motion, line.text or line.clip)


class MOTIONRT_OT_generate(_NeedsPackage, bpy.types.Operator):
    """Make a motion of words, on the active armature or a new one, from the current frame on"""

    bl_idname, bl_label = "motionrt.generate", "Generate"
    bl_options = {"REGISTER", "UNDO"}
    prompt: StringProperty(name="Prompt")
    seconds: FloatProperty(name="Seconds", default=0.0)
    seed: IntProperty(name="Seed", default=-1)

    def work(self, context: bpy.types.Context) -> str:
        """Text to motion."""
        chosen = context.scene.motionrt
        text = self.prompt or chosen.prompt
        seed = self.seed if self.seed >= 0 else chosen.seed
        return _put(context, runtime().generate(text, seconds=self.seconds or chosen.seconds, seed=seed), text)


class MOTIONRT_OT_walk_to_cursor(_NeedsPackage, bpy.types.Operator):
    """Let the character walk to the 3D cursor from where it is at the current frame, and stand there"""

    bl_idname, bl_label = "motionrt.walk_to_cursor", "Walk to cursor"
    bl_options = {"REGISTER", "UNDO"}

    def work(self, context: bpy.types.Context) -> str:
        """From the pose at the current frame, or from standing."""
        from . import armatures

        chosen, armature = context.scene.motionrt, armatures.target(context)
        start = armatures.seen(context, armature) if chosen.extend and armature.animation_data else None
        walk = runtime().walk(
            start=start, to=armatures.ground(armature, context.scene.cursor.location), speed=chosen.speed
        )
        return armatures.put(context, armature, walk.motion, "walk", fresh=start is None)


def _put(context: bpy.types.Context, motion: Motion, name: str) -> str:
    from . import armatures

    return armatures.put(context, armatures.target(context), motion, name, fresh=True)


def _gallery(context: bpy.types.Context) -> str | None:
    return bpy.path.abspath(context.scene.motionrt.gallery) or None


_CLASSES: tuple[Any, ...] = (
    MOTIONRT_OT_install,
    MOTIONRT_OT_search,
    MOTIONRT_OT_index,
    MOTIONRT_OT_apply,
    MOTIONRT_OT_generate,
    MOTIONRT_OT_walk_to_cursor,
)


def register() -> None:
    """The classes."""
    for kind in _CLASSES:
        bpy.utils.register_class(kind)


def unregister() -> None:
    """The reverse."""
    _runtime.clear()
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
