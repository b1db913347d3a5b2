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
        from . import preview

        motion, name = _found(context, self.index)
        preview.remove(context)
        return _put(context, motion, name)


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


class MOTIONRT_OT_walk_along(_NeedsPackage, bpy.types.Operator):
    """Let the character walk along the chosen curve, from its first point to its last"""

    bl_idname, bl_label = "motionrt.walk_along", "Walk along the curve"
    bl_options = {"REGISTER", "UNDO"}

    def work(self, context: bpy.types.Context) -> str:
        """In a new action, from the current frame on."""
        from . import armatures

        chosen, armature = context.scene.motionrt, armatures.target(context)
        walk = runtime().walk(path=armatures.way(context, armature, chosen.path), speed=chosen.speed)
        return armatures.put(context, armature, walk.motion, f"walk along {chosen.path.name}", fresh=True)


class MOTIONRT_OT_generate_timeline(_NeedsPackage, bpy.types.Operator):
    """Make one motion of the scene's markers, each a text until the next one; along the curve, if one is chosen"""

    bl_idname, bl_label = "motionrt.generate_timeline", "Generate from markers"
    bl_options = {"REGISTER", "UNDO"}
    seed: IntProperty(name="Seed", default=-1)

    def work(self, context: bpy.types.Context) -> str:
        """In a new action, from the first marker on."""
        from . import armatures, timeline

        chosen, scene = context.scene.motionrt, context.scene
        first, texts = timeline.of_markers(scene, armatures.rate(scene))
        armature = armatures.target(context)
        way = armatures.way(context, armature, chosen.path) if chosen.path else []
        constraints, start = timeline.along(way, texts[-1]["to"])
        seed = self.seed if self.seed >= 0 else chosen.seed
        made = runtime().generate(timeline=texts, constraints=constraints, seed=seed)
        motion = timeline.placed(made, start)
        scene.frame_set(first)
        return armatures.put(context, armature, motion, ", ".join(item["text"] for item in texts), fresh=True)


class MOTIONRT_OT_preview(_NeedsPackage, bpy.types.Operator):
    """Play the chosen clip on a figure of its own, beside everything else; Apply takes it away again"""

    bl_idname, bl_label = "motionrt.preview", "Preview"
    bl_options = {"REGISTER", "UNDO"}
    index: IntProperty(name="Hit", default=-1)

    def work(self, context: bpy.types.Context) -> str:
        """On the preview figure, at the 3D cursor."""
        from . import armatures, preview

        motion, name = _found(context, self.index)
        active = context.active_object
        ghost = preview.figure(context)
        said = armatures.put(context, ghost, motion, f"preview of {name}", fresh=True)
        preview.select(context, active)
        return said


def _found(context: bpy.types.Context, index: int) -> tuple[Motion, str]:
    """The motion of a hit, or of the one that is chosen, and its name."""
    chosen = context.scene.motionrt
    index = index if index >= 0 else chosen.hit
    if index >= len(chosen.hits):
        raise installing.InstallError("search first, then choose a hit")
    line = chosen.hits[index]
    gallery = runtime().gallery(_gallery(context))
    return gallery.motion(line.clip).between(line.start_s, line.end_s).canonical(), line.text or line.clip


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
    MOTIONRT_OT_walk_along,
    MOTIONRT_OT_generate_timeline,
    MOTIONRT_OT_preview,
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
