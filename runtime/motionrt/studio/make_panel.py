"""Make: motion from text, two motions in one body, and what a motion shows in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.body_parts import PARTS
from motionrt.studio.clips import Clip
from motionrt.studio.jobs import Told
from motionrt.synthesis.sampling import LONGEST_S, SHORTEST_S

if TYPE_CHECKING:
    from motionrt.retrieval import Description
    from motionrt.studio.windows import StudioWindow

ALIGN = {"from the start": "start", "stretched": "stretch", "in step": "phase"}
EMPTY = "empty"
MOST = 6


class MakePanel:
    """The tab.

    Args:
        session: whose.
    """

    def __init__(self, session: StudioWindow) -> None:
        self._session = session
        self._slots: dict[str, Clip | None] = {"A": None, "B": None}
        gui = session.client.gui
        with gui.add_folder("Generate"):
            self._add_generate(gui)
        with gui.add_folder("Compose"):
            self._add_compose(gui)
        with gui.add_folder("Describe"):
            describe: Any = gui.add_button("Describe the selected clip", icon="message")
            self._words: Any = gui.add_markdown("")
        describe.on_click(session.guarded(lambda _: self.describe()))

    def refresh(self) -> None:
        """After other clips came: descriptions are of the old ones."""
        self._words.content = ""

    def _add_generate(self, gui: Any) -> None:
        with gui.add_form(None) as form:
            self._text: Any = gui.add_text("What", initial_value="wave the right hand")
        self._seconds: Any = gui.add_slider("Seconds", SHORTEST_S, max(LONGEST_S.values()), 0.5, 4.0)
        self._count: Any = gui.add_slider("How many", 1, MOST, 1, 1)
        self._seed: Any = gui.add_number("Seed", 0, min=0, max=2**31 - 1, step=1)
        go: Any = gui.add_button("Generate", icon="wand", color="blue")
        guarded = self._session.guarded
        form.on_submit(guarded(lambda _: self.generate()))
        go.on_click(guarded(lambda _: self.generate()))

    def _add_compose(self, gui: Any) -> None:
        self._filled: Any = gui.add_markdown("")
        fill: Any = gui.add_button_group("Put selected in", ("A", "B"))
        gui.add_markdown("B moves these parts, A all the others:")
        self._parts: dict[str, Any] = {
            part: gui.add_checkbox(part, initial_value=part == "right arm") for part in PARTS
        }
        self._align: Any = gui.add_dropdown("Align", tuple(ALIGN))
        go: Any = gui.add_button("Compose", icon="layers-union", color="blue")
        guarded = self._session.guarded
        fill.on_click(guarded(lambda _: self.fill(fill.value)))
        go.on_click(guarded(lambda _: self.compose()))
        self._tell_slots()

    def generate(self) -> None:
        """Make motions of the text."""
        text, shop = self._text.value.strip(), self._session.workshop
        seconds, count, seed = float(self._seconds.value), int(self._count.value), int(self._seed.value)
        if not text:
            raise InvalidInputError("write what somebody does, as in: wave the right hand")

        def work(_: Told) -> list[Motion]:
            return shop.runtime.generate(text, seconds, n=count, seed=seed)

        def done(motions: list[Motion], took: float) -> None:
            note = f"generated in {took:.1f} s · seed {seed}"
            self._session.present([(text[:40], motion, note) for motion in motions])

        self._session.work(f"generating “{text}”", work, done)

    def fill(self, slot: str) -> None:
        """Put the selected clip into a slot."""
        self._slots[slot] = self._session.selected
        self._tell_slots()

    def compose(self) -> None:
        """Play A with the ticked parts of B."""
        a, b = self._slots["A"], self._slots["B"]
        if a is None or b is None:
            raise InvalidInputError("fill both slots: play a clip, then put it in A or B")
        parts = [part for part, box in self._parts.items() if box.value]
        if not parts:
            raise InvalidInputError("tick at least one part of the body that B moves")
        align, shop = ALIGN[self._align.value], self._session.workshop
        title, motions = f"{b.name} ({', '.join(parts)}) on {a.name}", [a.motion, b.motion]

        def work(_: Told) -> Motion:
            return shop.runtime.compose(motions, [None, parts], align=align)  # type: ignore[arg-type]

        def done(motion: Motion, took: float) -> None:
            self._session.present([(title[:60], motion.canonical(), f"composed in {1000 * took:.0f} ms")])

        self._session.work("composing", work, done)

    def describe(self) -> None:
        """What the selected clip shows, in words."""
        clip, shop = self._session.selected, self._session.workshop

        def work(_: Told) -> list[Description]:
            return shop.runtime.describe(clip.motion)

        def done(found: list[Description], _: float) -> None:
            rows = "\n".join(f"{d.rank}. {d.text} ({d.score:.2f})" for d in found)
            self._words.content = f"**{clip.name}**\n\n{rows}"

        self._session.work("describing", work, done)

    def _tell_slots(self) -> None:
        names = {slot: clip.name if clip else EMPTY for slot, clip in self._slots.items()}
        self._filled.content = "\n\n".join(f"**{slot}**: {name}" for slot, name in names.items())
