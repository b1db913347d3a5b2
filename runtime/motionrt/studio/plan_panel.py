"""Plan: texts on a timeline, places and targets that the motion meets, generated as one."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.studio import picking
from motionrt.studio.clicks import Clicks
from motionrt.studio.jobs import Told
from motionrt.studio.plan_draft import LONGEST_S, MOVES, WHOLE, PlanDraft
from motionrt.synthesis.constraints import JOINTS, Target, Waypoint

if TYPE_CHECKING:
    from motionrt.studio.windows import StudioWindow

PLACE, TARGET = "Place", "Hand or foot"
_EXAMPLE = "walk forward"
_MARK = 0.07  # metres, of a mark in the picture
LATEST_S = 10.0  # of a place or target where there is no text yet


class PlanPanel:
    """The tab.

    Args:
        session: whose.
    """

    def __init__(self, session: StudioWindow) -> None:
        self._session, self.draft = session, PlanDraft()
        self._rows: list[Any] = []
        self._marks: list[Any] = []
        self._clicks = Clicks(session.client, session.guarded(lambda e: self.click(e.ray_origin, e.ray_direction)))
        gui = session.client.gui
        self._picture: Any = gui.add_html(self.draft.picture())
        with gui.add_folder("Texts"):
            self._add_texts(gui)
            self._lines: Any = gui.add_folder("Times", visible=False)
        with gui.add_folder("Places and targets"):
            self._add_constraints(gui)
        self._seed: Any = gui.add_number("Seed", 0, min=0, max=2**31 - 1, step=1)
        go: Any = gui.add_button("Generate the plan", icon="wand", color="blue")
        plan: Any = gui.add_button("Download as plan", icon="file-download", color="gray")
        self._report: Any = gui.add_markdown("")
        go.on_click(session.guarded(lambda _: self.generate()))
        plan.on_click(session.guarded(lambda _: self._session.hand_over("plan.yaml", self.plan_text().encode())))

    def _add_texts(self, gui: Any) -> None:
        with gui.add_form(None) as form:
            self._text: Any = gui.add_text("Text", initial_value=_EXAMPLE)
        self._moves: Any = gui.add_dropdown("Moves", tuple(MOVES), initial_value=WHOLE, hint="Parts lie upon the rest")
        add: Any = gui.add_button("Add text", icon="plus")
        guarded = self._session.guarded
        form.on_submit(guarded(lambda _: self.add_text()))
        add.on_click(guarded(lambda _: self.add_text()))

    def _add_constraints(self, gui: Any) -> None:
        self._time: Any = gui.add_slider("At (s)", 0.0, LATEST_S, 0.1, 2.0)
        self._joint: Any = gui.add_dropdown("Which", JOINTS, initial_value="right_wrist")
        self._height: Any = gui.add_slider("Height (m)", 0.0, 2.2, 0.05, 1.2, hint="Of a hand or foot")
        which: Any = gui.add_button_group("Click in the picture", ("Look", PLACE, TARGET))
        self._told: Any = gui.add_markdown("")
        self._tool: str | None = None
        which.on_click(self._session.guarded(lambda _: self.take(which.value)))

    def take(self, tool: str) -> None:
        """What clicks mean from now on."""
        self._tool = tool if tool in {PLACE, TARGET} else None
        self._clicks.listen(on=self._tool is not None)
        words = {PLACE: "click where the pelvis is then", TARGET: "click below where it is then"}
        self._told.content = words.get(tool, "")

    def click(self, origin: Any, direction: Any) -> None:
        """A click in the picture: a ray that meets the ground."""
        hit = picking.ground_hit(origin, direction)
        if hit is None or self._tool is None:
            return
        x, z, time = round(float(hit[0]), 2), round(float(hit[2]), 2), round(float(self._time.value), 1)
        draft = self.draft
        if self._tool == PLACE:
            others = [w for w in draft.path if w.time != time]
            path = sorted([*others, Waypoint(time, (x, z))], key=lambda w: w.time)
            self.change(PlanDraft(draft.lines, tuple(path), draft.targets))
        else:
            target = Target(time, self._joint.value, (x, round(float(self._height.value), 2), z))
            self.change(PlanDraft(draft.lines, draft.path, (*draft.targets, target)))

    def add_text(self) -> None:
        """The text that was written, behind or upon the others."""
        self.change(self.draft.with_text(self._text.value, self._moves.value))

    def change(self, draft: PlanDraft) -> None:
        """Another draft."""
        if draft != self.draft:
            self._session.remember()
            self.put(draft)

    def put(self, draft: PlanDraft) -> None:
        """Show a draft."""
        self.draft = draft
        self._picture.content = draft.picture()
        self._time.max = max(draft.duration, 1.0) if draft.lines else LATEST_S
        self._time.value = min(float(self._time.value), self._time.max)
        for row in self._rows:
            row.remove()
        with self._lines:
            self._rows = [self._line(index) for index in range(len(draft.lines))]
            if draft.lines:
                self._rows.append(self._remover())
        self._lines.visible = bool(draft.lines)
        self._mark(draft)

    def _line(self, index: int) -> Any:
        line, longest = self.draft.lines[index], max(self.draft.duration + LONGEST_S, 10.0)
        slider: Any = self._session.client.gui.add_multi_slider(
            f"{index + 1}. {line.text}"[:24],
            0.0,
            round(longest, 1),
            0.1,
            (round(line.start, 1), round(line.end, 1)),
            hint=f"{line.moves}: from when to when",
        )
        slider.on_update(self._session.guarded(lambda _: self._spanned(index, slider.value)))
        return slider

    def _spanned(self, index: int, span: tuple[float, ...]) -> None:
        self._session.remember()
        draft = self.draft.with_span(index, min(span), max(span))
        if draft.lines[index] == self.draft.lines[index] or len(draft.lines) == 1:
            self.draft = draft  # the slider that is being dragged stays
            self._picture.content = draft.picture()
        else:
            self.put(draft)

    def _remover(self) -> Any:
        names = [f"text {i + 1}: {line.text}" for i, line in enumerate(self.draft.lines)]
        names += [f"place at {w.time:g} s" for w in self.draft.path]
        names += [f"{t.joint} at {t.time:g} s" for t in self.draft.targets]
        kinds = ["lines"] * len(self.draft.lines) + ["path"] * len(self.draft.path)
        kinds += ["targets"] * len(self.draft.targets)
        box: Any = self._session.client.gui.add_dropdown("Remove", ("-", *dict.fromkeys(names)))

        def chosen(_: Any) -> None:
            if box.value in names:
                number = names.index(box.value)
                self.change(self.draft.without(kinds[number], number - kinds.index(kinds[number])))

        box.on_update(self._session.guarded(chosen))
        return box

    def _mark(self, draft: PlanDraft) -> None:
        for node in self._marks:
            node.remove()
        scene, marks = self._session.client.scene, []
        for number, way in enumerate(draft.path):
            marks.append((f"/plan/place{number}", (way.place[0], 0.02, way.place[1]), (0, 114, 178), f"{way.time:g} s"))
        for number, target in enumerate(draft.targets):
            marks.append((f"/plan/target{number}", target.place, (213, 94, 0), f"{target.joint} {target.time:g} s"))
        self._marks = []
        for name, place, colour, words in marks:
            self._marks.append(scene.add_icosphere(name, radius=_MARK, color=colour, position=place))
            above = (place[0], place[1] + 2 * _MARK, place[2])
            self._marks.append(scene.add_label(f"{name}/words", words, position=above, font_screen_scale=0.75))

    def plan_text(self) -> str:
        """The plan as YAML."""
        self._check()
        return self.draft.text()

    def generate(self) -> None:
        """Make the motion of the plan."""
        self._check()
        draft, shop, seed = self.draft, self._session.workshop, int(self._seed.value)

        def work(_: Told) -> Motion:
            return shop.runtime.generate(timeline=draft.timeline(), constraints=draft.constraints(), seed=seed)

        self._session.work("generating the plan", work, partial(self._generated, draft))

    def _generated(self, draft: PlanDraft, motion: Motion, seconds: float) -> None:
        from motionrt.synthesis.misses import misses

        found = misses(motion, draft.constraints())
        rows = [f"* {m.what} at {m.time:g} s: {m.cm:.1f} cm off" for m in found]
        self._report.content = "\n".join([f"generated in {seconds:.1f} s", "", *rows])
        self._session.present([("plan", motion, f"{len(draft.lines)} texts")], world=True, dear=True)

    def open(self, file: Path) -> None:
        """Take over a plan that was uploaded."""
        from motionrt.synthesis.plan import Plan

        self.change(PlanDraft.of(Plan.read(file)))

    def _check(self) -> None:
        if not self.draft.lines:
            raise InvalidInputError(f"the plan has no text yet: write one, as in '{_EXAMPLE}', and add it")
