"""The panel in the sidebar of the 3D viewport."""

from __future__ import annotations

import bpy

from . import installing


class MOTIONRT_UL_hits(bpy.types.UIList):
    """The clips that were found, best first."""

    def draw_item(self, _context, layout, _data, item, _icon, _active, _property, _index=0) -> None:
        """One line: score and clip."""
        row = layout.row()
        row.label(text=f"{item.score:.2f}  {item.text or item.clip}")
        row.label(text=f"{item.end_s - item.start_s:.1f} s")


class MOTIONRT_PT_panel(bpy.types.Panel):
    """Search, generate, walk."""

    bl_label = "motionrt"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "motionrt"

    def draw(self, context: bpy.types.Context) -> None:
        """The whole panel; before the package is there, only a button that installs it."""
        if not installing.available():
            self.layout.label(text="The motionrt package is not installed yet", icon="INFO")
            self.layout.operator("motionrt.install", icon="IMPORT")
            return
        self._target(context)
        self._search(context.scene.motionrt)
        self._generate(context.scene.motionrt)
        self._walk(context.scene.motionrt)
        self._way(context)

    def _target(self, context: bpy.types.Context) -> None:
        active = context.active_object
        chosen = active.name if active and active.type == "ARMATURE" else "a new armature"
        self.layout.label(text=f"Onto: {chosen}", icon="ARMATURE_DATA")

    def _search(self, settings: bpy.types.PropertyGroup) -> None:
        box = self.layout.box()
        row = box.row(align=True)
        row.prop(settings, "query", text="", icon="VIEWZOOM")
        row.operator("motionrt.search", text="Search")
        row = box.row(align=True)
        row.prop(settings, "gallery", text="")
        row.operator("motionrt.index", text="Index")
        if len(settings.hits):
            box.template_list("MOTIONRT_UL_hits", "", settings, "hits", settings, "hit", rows=5)
            row = box.row(align=True)
            row.operator("motionrt.preview", icon="HIDE_OFF")
            row.operator("motionrt.apply", icon="POSE_HLT")

    def _generate(self, settings: bpy.types.PropertyGroup) -> None:
        box = self.layout.box()
        box.prop(settings, "prompt", text="")
        row = box.row(align=True)
        row.prop(settings, "seconds")
        row.prop(settings, "seed")
        box.operator("motionrt.generate", icon="OUTLINER_OB_FONT")

    def _walk(self, settings: bpy.types.PropertyGroup) -> None:
        box = self.layout.box()
        row = box.row(align=True)
        row.prop(settings, "speed")
        row.prop(settings, "extend")
        box.operator("motionrt.walk_to_cursor", icon="PIVOT_CURSOR")

    def _way(self, context: bpy.types.Context) -> None:
        box = self.layout.box()
        box.prop(context.scene.motionrt, "path")
        row = box.row()
        row.enabled = context.scene.motionrt.path is not None
        row.operator("motionrt.walk_along", icon="CURVE_PATH")
        row = box.row()
        row.enabled = len(context.scene.timeline_markers) > 0
        row.operator("motionrt.generate_timeline", icon="MARKER_HLT")


_CLASSES = (MOTIONRT_UL_hits, MOTIONRT_PT_panel)


def register() -> None:
    """The classes."""
    for kind in _CLASSES:
        bpy.utils.register_class(kind)


def unregister() -> None:
    """The reverse."""
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
