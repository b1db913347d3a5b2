"""What a browser window shows in three dimensions: figures, their trails and feet; everything by the clock.

Per frame of a figure only its 22 bones are sent, 14 kB at 30 Hz before compression; meshes are sent once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from motionrt.errors import MotionRTError
from motionrt.formats import Character
from motionrt.motion.skeleton import FloatArray
from motionrt.studio import layout, shapes, titles
from motionrt.studio.bodies import Body, CharacterBody, FigureBody
from motionrt.studio.clips import Clip

SHADOW, STEP_HEIGHT, TRAIL_HEIGHT = 0.004, 0.010, 0.007  # metres above the ground, so that nothing flickers
BLOT = ((0.32, 0.0), (0.24, 0.001), (0.15, 0.002))  # radius and lift of its discs, metres
SHADOW_COLOUR = (40, 44, 56)
TITLE_ABOVE, TITLE_ROOM = 0.08, 0.3  # metres above the head: where a name begins, and where it ends


@dataclass
class Look:
    """What is drawn of every clip."""

    trails: bool = True
    feet: bool = True
    names: bool = False
    titles: bool = True
    layout: str = layout.AS_RECORDED


@dataclass(eq=False)
class Actor:
    """A clip on the stage, and the nodes that show it."""

    clip: Clip
    offset: FloatArray
    root: Any
    body: Body
    shadow: Any
    feet: list[Any]
    extras: list[Any] = field(default_factory=list)
    labels: list[Any] = field(default_factory=list)
    title: Any = None
    visible: bool = True

    @property
    def box(self) -> FloatArray:
        """``(2, 3)`` corners of all that its skin touches, on the stage."""
        return self.body.box(self.clip) + self.offset


class Stage:
    """The clips of one browser window.

    Args:
        client: of viser.
    """

    def __init__(self, client: Any) -> None:
        self.client = client
        self.look = Look()
        self.actors: list[Actor] = []
        self.character: Character | None = None
        self._spare: list[Actor] = []
        self._count = 0

    @property
    def clips(self) -> list[Clip]:
        """The clips on the stage."""
        return [actor.clip for actor in self.actors]

    @property
    def duration(self) -> float:
        """Seconds of the longest clip that is visible."""
        return max((actor.clip.motion.duration for actor in self.actors if actor.visible), default=0.0)

    @property
    def fps(self) -> float:
        """The highest frame rate of the visible clips."""
        return max((actor.clip.motion.fps for actor in self.actors if actor.visible), default=30.0)

    @property
    def boxes(self) -> list[FloatArray]:
        """Boxes around all visible clips, with the names over them."""
        above = np.array([[0, 0, 0], [0, TITLE_ROOM if self._titled else 0, 0]], np.float32)
        return [actor.box + above for actor in self.actors if actor.visible]

    @property
    def _titled(self) -> bool:
        return self.look.titles and len(self.actors) > 1

    def show(self, clips: Sequence[Clip], time: float = 0.0) -> None:
        """Show these clips and no others; those that stay are not sent again."""
        kept = {id(actor.clip): actor for actor in self.actors}
        for actor in self.actors:
            if actor.clip not in clips:
                self._leave(actor)
        with self.client.atomic():
            self.actors = [kept.get(id(clip)) or self._actor(clip) for clip in clips]
            self.arrange(time)

    def wear(self, character: Character | None, time: float) -> None:
        """Show all clips on a character of the user's own, or on the figure.

        Raises:
            RigError: a clip cannot be played on it; what was there stays.
        """
        before, clips = self.character, self.clips
        if character is before:
            return
        self.character = character
        try:
            with self.client.atomic():
                new = [self._actor(clip) for clip in clips]
        except MotionRTError:
            self.character = before
            raise
        for actor in self.actors:
            self._leave(actor)
        with self.client.atomic():
            self.actors = new
            self.arrange(time)

    def arrange(self, time: float) -> None:
        """Place the clips by the layout, and draw what does not move."""
        seen = [actor for actor in self.actors if actor.visible]
        boxes, starts = [a.body.box(a.clip) for a in seen], [a.clip.motion.root[0] for a in seen]
        for actor, offset in zip(seen, layout.offsets(boxes, starts, self.look.layout), strict=True):
            actor.offset = offset
            actor.root.position = tuple(map(float, offset))
        for actor in self.actors:
            actor.root.visible = actor.visible
            self._furnish(actor)
        self.draw(time)

    def draw(self, time: float) -> None:
        """Move every figure to where it is at a time."""
        with self.client.atomic():
            for actor in self.actors:
                if actor.visible:
                    _draw(actor, time)
            self._part_titles()

    def _part_titles(self) -> None:
        """Names that lie upon each other in the picture are parted."""
        titled, camera = [actor for actor in self.actors if actor.title is not None], self.client.camera
        if len(titled) < 2 or not camera.image_height:
            return
        places = np.array([np.add(actor.title.position, actor.offset) for actor in titled], np.float32)
        widths = np.array([titles.width(actor.title.text) for actor in titled], np.float32)
        up = titles.lifts(places, widths, camera.position, camera.look_at, camera.fov, camera.image_height)
        for actor, lift in zip(titled, up.tolist(), strict=True):
            if lift:
                x, y, z = actor.title.position
                actor.title.position = (x, y + lift, z)

    def focus(self, time: float) -> FloatArray:
        """``(3,)`` middle of the visible figures at a time, metres."""
        places = [actor.clip.at(time)[0][0] + actor.offset for actor in self.actors if actor.visible]
        return np.mean(places, axis=0) if places else np.array([0, 0.9, 0], dtype=np.float32)

    def _actor(self, clip: Clip) -> Actor:
        """Somebody who has left the stage comes back as another; else somebody new."""
        skeleton = clip.motion.skeleton
        for spare in self._spare:
            if spare.body.suits(skeleton, self.character):
                self._spare.remove(spare)
                return _recast(spare, clip)
        self._count += 1
        name = f"/clips/{self._count}"
        root = self.client.scene.add_frame(name, show_axes=False)
        feet = [self._foot(f"{name}/foot{side}", clip) for side in range(2)]
        body, shadow = self._body(f"{name}/body", clip), self._shadow(f"{name}/shadow")
        return Actor(clip, np.zeros(3, np.float32), root, body, shadow, feet)

    def _body(self, name: str, clip: Clip) -> Body:
        if self.character is None:
            return FigureBody(self.client.scene, name, clip)
        return CharacterBody(self.client.scene, name, clip, self.character)

    def _shadow(self, name: str) -> Any:
        """A soft blot below the pelvis: three discs on top of each other."""
        blot = shapes.joined([_moved(shapes.disc(radius), np.array([0, lift, 0], np.float32)) for radius, lift in BLOT])
        return self.client.scene.add_mesh_simple(
            name, *blot, color=SHADOW_COLOUR, opacity=0.07, cast_shadow=False, receive_shadow=False
        )

    def _foot(self, name: str, clip: Clip) -> Any:
        """The ring that lights up round a foot while it stands."""
        return self.client.scene.add_mesh_simple(
            name, *shapes.ring(0.085, 0.105), color=clip.colour, cast_shadow=False, receive_shadow=False, visible=False
        )

    def _furnish(self, actor: Actor) -> None:
        """Trail, footsteps and names, as far as they are wanted."""
        for node in (*actor.extras, *actor.labels):
            node.remove()
        actor.extras, actor.labels, actor.title = [], [], None
        if not actor.visible:
            return
        scene, name = self.client.scene, actor.root.name
        plain: dict[str, Any] = {"color": actor.clip.colour, "cast_shadow": False, "receive_shadow": False}
        trail = actor.clip.trail()
        if self.look.trails and len(trail) > 1:
            band = shapes.ribbon(trail, 0.04, TRAIL_HEIGHT)
            actor.extras.append(scene.add_mesh_simple(f"{name}/trail", *band, opacity=0.75, **plain))
        places = actor.clip.footsteps[0]
        if self.look.feet and len(places):
            spots = places * (1, 0, 1) + (0, STEP_HEIGHT - 0.002, 0)
            marks = shapes.joined([_moved(shapes.disc(0.045, 16), place) for place in spots])
            actor.extras.append(scene.add_mesh_simple(f"{name}/steps", *marks, opacity=0.35, **plain))
        for ring in actor.feet:
            ring.visible = False
        if self._titled:
            title = titles.short(f"{self.actors.index(actor) + 1}. {actor.clip.name}", len(self.actors))
            actor.title = scene.add_label(f"{name}/title", title, font_screen_scale=0.85, anchor="bottom-center")
            actor.extras.append(actor.title)
        if self.look.names:
            joints = zip(actor.clip.motion.skeleton.names, actor.clip.joints[0], strict=False)
            actor.labels = [
                scene.add_label(
                    f"{name}/names/{joint}", joint, position=tuple(map(float, place)), font_screen_scale=0.7
                )
                for joint, place in joints
            ]

    def _leave(self, actor: Actor) -> None:
        """Off the stage, but kept: the page need not get a body twice (and viser 1.1 ends when one is taken away)."""
        for node in (*actor.extras, *actor.labels):
            node.remove()
        actor.extras, actor.labels, actor.title = [], [], None
        actor.root.visible = False
        self._spare.append(actor)


def _recast(actor: Actor, clip: Clip) -> Actor:
    actor.body.play(clip)
    for node in actor.feet:
        node.color = clip.colour
    return Actor(clip, np.zeros(3, np.float32), actor.root, actor.body, actor.shadow, actor.feet)


def _draw(actor: Actor, time: float) -> None:
    joints, turns = actor.clip.at(time)
    top = actor.body.pose(joints, turns, time)
    actor.shadow.position = (float(joints[0, 0]), SHADOW, float(joints[0, 2]))
    if actor.title is not None:
        actor.title.position = (float(joints[0, 0]), top + TITLE_ABOVE, float(joints[0, 2]))
    for label, place in zip(actor.labels, joints.tolist(), strict=False):
        label.position = place
    _draw_feet(actor, time)


def _draw_feet(actor: Actor, time: float) -> None:
    if not actor.extras:
        return
    places, spans = actor.clip.footsteps
    standing = places[(spans[:, 0] <= time) & (time < spans[:, 1])] if len(places) else places
    for index, ring in enumerate(actor.feet):
        ring.visible = index < len(standing)
        if index < len(standing):
            ring.position = (float(standing[index, 0]), STEP_HEIGHT, float(standing[index, 2]))


def _moved(mesh: shapes.Mesh, by: FloatArray) -> shapes.Mesh:
    return (mesh[0] + by).astype(np.float32), mesh[1]
