"""The panels of clips and of the view: which clips are seen, how they are laid out, what is drawn of them."""

from __future__ import annotations

import html
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from motionrt.studio.layout import LAYOUTS
from motionrt.studio.page_script import UNSAVED

if TYPE_CHECKING:
    from motionrt.studio.clips import Clip
    from motionrt.studio.stage import Actor
    from motionrt.studio.windows import Window


class ViewPanel:
    """The controls of a session's stage.

    Args:
        session: whose.
        selecting: whether one of several clips can be selected.
    """

    def __init__(self, session: Window, *, selecting: bool = False) -> None:
        self._session, self.selecting = session, selecting
        gui, look = session.client.gui, session.stage.look
        self._clips: Any = gui.add_folder("Clips")
        self._rows: list[Any] = []
        self._selected: Any = None
        with gui.add_folder("View"):
            self._layout: Any = gui.add_dropdown("Layout", LAYOUTS, initial_value=look.layout)
            self._trails: Any = gui.add_checkbox("Trails", initial_value=look.trails, hint="Way of the pelvis")
            self._feet: Any = gui.add_checkbox("Planted feet", initial_value=look.feet)
            self._titles: Any = gui.add_checkbox("Clip names", initial_value=look.titles)
            self._names: Any = gui.add_checkbox("Joint names", initial_value=look.names)
            self._follow: Any = gui.add_checkbox("Camera follows", initial_value=False)
            frame: Any = gui.add_button("Frame all", icon="focus-2", hint="Key F")
        for control in (self._layout, self._trails, self._feet, self._titles, self._names, self._follow):
            control.on_update(session.guarded(lambda _: self._changed()))
        frame.on_click(session.guarded(lambda _: session.frame_all()))
        gui.add_command("Frame all", hotkey="F").on_trigger(session.guarded(lambda _: session.frame_all()))

    def refresh(self) -> None:
        """After other clips came: a row for each."""
        for row in self._rows:
            row.remove()
        self._rows = []
        actors, gui = self._session.stage.actors, self._session.client.gui
        with self._clips:
            self._legend: Any = gui.add_html(legend(actors, self._session.unsaved()))
            self._rows.append(self._legend)
            self._selected = None
            if len(actors) > 1:
                self._rows += [self._switch(actor) for actor in actors]
                if self.selecting:
                    names = [actor.clip.name for actor in actors]
                    self._selected = gui.add_dropdown("Selected", names, hint="What buttons mean")
                    self._selected.on_update(self._session.guarded(lambda _: self._session.chosen()))
                    self._rows.append(self._selected)

    def tell_saved(self) -> None:
        """After clips were saved."""
        self._legend.content = legend(self._session.stage.actors, self._session.unsaved())

    def chosen(self) -> Clip | None:
        """The clip that is selected among several; None without a choice."""
        if self._selected is None:
            return None
        return next((clip for clip in self._session.stage.clips if clip.name == self._selected.value), None)

    def set_layout(self, layout: str) -> None:
        """Choose a layout for what comes next."""
        self._session.stage.look.layout = self._layout.value = layout

    def set_follow(self, *, on: bool) -> None:
        """Whether the camera goes along with what comes next."""
        self._session.follow = self._follow.value = on

    def _switch(self, actor: Actor) -> Any:
        number = self._session.stage.actors.index(actor) + 1
        box = self._session.client.gui.add_checkbox(f"Show {number}", initial_value=actor.visible, hint=actor.clip.name)

        def changed(_: Any) -> None:
            actor.visible = bool(box.value)
            self._session.rearrange()

        box.on_update(self._session.guarded(changed))
        return box

    def _changed(self) -> None:
        look, session = self._session.stage.look, self._session
        turned = look.layout != self._layout.value
        session.follow = bool(self._follow.value)
        look.layout, look.trails = self._layout.value, bool(self._trails.value)
        look.feet, look.names = bool(self._feet.value), bool(self._names.value)
        look.titles = bool(self._titles.value)
        session.rearrange()
        if turned:
            session.frame_all()


def legend(actors: Sequence[Actor], unsaved: Sequence[Clip] = ()) -> str:
    """Colour, name, length and frame rate of every clip, and whether it is to be saved yet, as HTML."""
    if not actors:
        return '<div style="padding:0.3em 0.6em;opacity:0.6;font-size:0.85em">Nothing on the stage yet.</div>'
    several = len(actors) > 1
    return "".join(
        _row(actor, f"{number}. " if several else "", unsaved=actor.clip in unsaved)
        for number, actor in enumerate(actors, start=1)
    )


def _row(actor: Actor, number: str, *, unsaved: bool) -> str:
    clip = actor.clip
    dot = f"background:rgb{clip.colour};width:0.8em;height:0.8em;border-radius:50%;flex:none"
    facts = f"{clip.motion.duration:.1f} s · {clip.motion.fps:g} fps"
    note = f" · {html.escape(clip.note)}" if clip.note else ""
    note += f'<span class="{UNSAVED}"> · not saved</span>' if unsaved else ""
    return (
        '<div style="display:flex;gap:0.6em;align-items:center;padding:0.25em 0.6em;font-size:0.85em;line-height:1.25">'
        f'<span style="{dot}"></span><span style="overflow-wrap:anywhere">{number}{html.escape(clip.name)}'
        f'<br><span style="opacity:0.55">{facts}{note}</span></span></div>'
    )
