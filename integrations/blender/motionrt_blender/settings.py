"""What the panel shows and keeps in the scene, and the add-on's preferences."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, CollectionProperty, FloatProperty, IntProperty, PointerProperty, StringProperty


class MotionrtHit(bpy.types.PropertyGroup):
    """A clip that was found."""

    clip: StringProperty(name="Clip")
    text: StringProperty(name="Text")
    score: FloatProperty(name="Score")
    start_s: FloatProperty(name="Start", unit="TIME_ABSOLUTE")
    end_s: FloatProperty(name="End", unit="TIME_ABSOLUTE")


class MotionrtSettings(bpy.types.PropertyGroup):
    """``scene.motionrt``."""

    query: StringProperty(name="Search", description="What the motion shows: a person climbs a ladder")
    gallery: StringProperty(
        name="Library",
        subtype="DIR_PATH",
        description="An indexed folder of motion files; empty for the starter library",
    )
    hits: CollectionProperty(type=MotionrtHit)
    hit: IntProperty(name="Hit")
    prompt: StringProperty(name="Prompt", default="a person waves with the right hand")
    seconds: FloatProperty(name="Seconds", default=4.0, min=0.5, max=8.0)
    seed: IntProperty(name="Seed", default=1, min=0)
    speed: FloatProperty(name="Speed", default=1.2, min=0.3, max=2.0, description="Metres per second")
    path: PointerProperty(
        name="Path",
        type=bpy.types.Object,
        poll=lambda _settings, thing: thing.type == "CURVE",
        description="A curve of the scene to walk along, or that a timeline keeps to",
    )
    extend: BoolProperty(
        name="Go on from here",
        default=True,
        description="Walk on from the pose at the current frame, after the keys before it; else in a new action",
    )


class MotionrtPreferences(bpy.types.AddonPreferences):
    """Where the package comes from."""

    bl_idname = __package__

    source: StringProperty(
        name="Package", default="motionrt", description="A name on PyPI, a wheel, or a folder with the sources"
    )

    def draw(self, _context: bpy.types.Context) -> None:
        """In Edit > Preferences > Add-ons."""
        self.layout.prop(self, "source")
        self.layout.operator("motionrt.install")


_CLASSES = (MotionrtHit, MotionrtSettings, MotionrtPreferences)


def source() -> str:
    """What the preferences say that is to be installed."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences.source if addon else "motionrt"


def register() -> None:
    """The classes, and ``scene.motionrt``."""
    for kind in _CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Scene.motionrt = PointerProperty(type=MotionrtSettings)


def unregister() -> None:
    """The reverse."""
    del bpy.types.Scene.motionrt
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
