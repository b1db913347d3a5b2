"""Direct: a scene, clicks in it, and a character that does what they say."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.locomotion import Act, Do, Stand, Wait
from motionrt.motion import SMPL24, Motion
from motionrt.studio import draft as drafts
from motionrt.studio import picking
from motionrt.studio.clicks import Clicks
from motionrt.studio.draft import Draft, Options
from motionrt.studio.gizmos import Dragged, Gizmos
from motionrt.studio.jobs import Told
from motionrt.studio.postures import Place
from motionrt.studio.scenery import is_plan, open_scenery
from motionrt.studio.script_text import script_text
from motionrt.studio.uploads import SCENE_SUFFIXES

if TYPE_CHECKING:
    from motionrt.locomotion import Performance, Script
    from motionrt.studio.scenery import Scenery
    from motionrt.studio.windows import StudioWindow

OFF = "Look"
MOVES = {OFF: None, "Walk": drafts.WALK, "Path": drafts.PATH, "Start": drafts.START}
POSES = {"Sit": drafts.SIT, "Grab L": drafts.GRAB_LEFT, "Grab R": drafts.GRAB_RIGHT, "Joint": drafts.JOINT}
SEED = 0
OPEN_GROUND = np.array([[-3, 0, -2], [3, 1.7, 5]], dtype=np.float32)  # metres, what is seen of it at first


class DirectPanel:
    """The tab.

    Args:
        session: whose.
    """

    def __init__(self, session: StudioWindow) -> None:
        self._session = session
        self.draft = Draft() if session.given.draft is None else session.given.draft
        self._tool: str | None = None
        self._clicks = Clicks(session.client, session.guarded(lambda e: self.click(e.ray_origin, e.ray_direction)))
        self._gizmos = Gizmos(session.client, session.guarded(self._dragged))
        gui = session.client.gui
        with gui.add_folder("Scene"):
            self._add_scene(gui)
        with gui.add_folder("Click in the picture"):
            self._add_tools(gui)
        with gui.add_folder("Steps"):
            self._add_steps(gui)
        self._tell()

    @property
    def scenery(self) -> Scenery | None:
        """The scene of the window."""
        return self._session.scenery

    def _add_scene(self, gui: Any) -> None:
        guarded = self._session.guarded
        upload: Any = gui.add_upload_button("Upload a mesh, a map or a script", icon="upload")
        upload.on_upload(guarded(lambda _: self.uploaded(upload.value.name, upload.value.content)))

    def _add_tools(self, gui: Any) -> None:
        guarded = self._session.guarded
        moves: Any = gui.add_button_group("Move", tuple(MOVES))
        poses: Any = gui.add_button_group("Pose", tuple(POSES))
        self._told: Any = gui.add_markdown("")
        self._joint: Any = gui.add_dropdown("Joint", SMPL24.names, initial_value="right_hand", visible=False)
        self._height: Any = gui.add_slider("Height (m)", 0.0, 2.2, 0.05, 1.1, hint="Of a click that meets the ground")
        self._hold: Any = gui.add_slider("Hold (s)", 0.0, 10.0, 0.5, 2.0)
        self._drag: Any = gui.add_checkbox("Drag keypoints", initial_value=False, hint="Of the last pose")
        moves.on_click(guarded(lambda _: self.take(MOVES[moves.value])))
        poses.on_click(guarded(lambda _: self.take(POSES[poses.value])))
        self._drag.on_update(guarded(lambda _: self._tell()))

    def _add_steps(self, gui: Any) -> None:
        guarded = self._session.guarded
        self._list: Any = gui.add_markdown("")
        more: Any = gui.add_button_group("Add", ("Stand", "Wait"))
        self._do: Any = gui.add_text("In words", initial_value="", visible=False, hint="sit on the sofa")
        self._add_do: Any = gui.add_button("Add words", visible=False, icon="plus")
        undo: Any = gui.add_button("Undo", icon="arrow-back-up", hint="Key Z")
        clear: Any = gui.add_button("Clear", icon="trash", color="gray")
        self._speed: Any = gui.add_slider("Speed (m/s)", 0.4, 3.0, 0.1, 1.2)
        preview: Any = gui.add_button("Preview poses", icon="eye", color="gray", hint="Before it is performed")
        go: Any = gui.add_button("Perform", icon="run", color="blue")
        script: Any = gui.add_button("Download as script", icon="file-download", color="gray")
        self._report: Any = gui.add_markdown("")
        more.on_click(guarded(lambda _: self._more(more.value)))
        self._add_do.on_click(guarded(lambda _: self.say_words(self._do.value)))
        undo.on_click(guarded(lambda _: self._session.undo()))
        clear.on_click(guarded(lambda _: self.change(Draft(self.draft.start))))
        preview.on_click(guarded(lambda _: self.preview()))
        go.on_click(guarded(lambda _: self.perform()))
        script.on_click(guarded(lambda _: self.download()))

    def load(self, file: Path) -> None:
        """Open a scene, a script with its scene and steps, or a plan.

        Raises:
            MotionRTError: it cannot be read; the message says why.
        """
        if is_plan(file):
            self._session.open_plan(file)
            return
        scenery, script = open_scenery(file)
        if scenery is not None or script is None:
            self._session.set_scenery(scenery)
        if script is not None:
            self._take_script(script)
        self._do.visible = self._add_do.visible = self.scenery is not None and self.scenery.cloud is not None
        self._session.frame_all()
        self._session.say("Scene loaded", self.scenery.name if self.scenery else file.name)

    def _take_script(self, script: Script) -> None:
        self._speed.value = min(max(script.speed, 0.4), 3.0)
        self.change(Draft(script.start, tuple(script.steps)))

    def uploaded(self, name: str, content: bytes) -> None:
        """Open a scene, a script or a plan of the user's, or keep what one of them names."""
        uploads = self._session.uploads
        file = uploads.keep(name, content)
        if file.suffix.lower() not in SCENE_SUFFIXES:
            self._session.say("Uploaded", f"{file.name}; a script or a map may name it")
            return
        with uploads.alone():
            self.load(file)

    def take(self, tool: str | None) -> None:
        """Another tool: what clicks mean from now on; None for nothing."""
        if tool is not None and self._tool is None and self.scenery is None and not self.draft.actions:
            self._session.frame_all(OPEN_GROUND)
        self._tool = tool
        self._joint.visible = tool == drafts.JOINT
        self._clicks.listen(on=tool is not None)
        self._tell()

    def click(self, origin: Any, direction: Any) -> None:
        """A click in the picture: a ray."""
        if self._tool is None:
            return
        hit = self.scenery.hit(origin, direction) if self.scenery else picking.ground_hit(origin, direction)
        if hit is None:
            return
        x, y, z = (round(float(value), 3) for value in hit)
        if self._tool == drafts.JOINT and y < 0.1 and not self._joint.value.endswith("_foot"):
            y += float(self._height.value)
        options = Options(self._joint.value, float(self._hold.value), float(self._height.value))
        self.change(self.draft.clicked(self._tool, (x, y, z), options, self._free()))

    def _free(self) -> Any:
        if self.scenery is None:
            return None
        scene = self.scenery.scene

        def free(place: Place) -> bool:
            return bool(scene.free(np.array(place, dtype=np.float32)))

        return free

    def say_words(self, text: str) -> None:
        """A step in words."""
        if not text.strip():
            raise InvalidInputError("write what to do, as in: sit on the sofa")
        self.change(self.draft.added(Do(text.strip(), float(self._hold.value))))

    def _more(self, which: str) -> None:
        hold = float(self._hold.value)
        self.change(self.draft.added(Stand(hold) if which == "Stand" else Wait(hold)))

    def change(self, draft: Draft) -> None:
        """Another draft."""
        if draft != self.draft:
            self._session.remember()
        self.put(draft)

    def put(self, draft: Draft) -> None:
        """Show a draft."""
        self.draft = draft
        self._tell()

    def _dragged(self, drag: Dragged) -> None:
        self.change(self.draft.moved(drag.index, drag.joint, drag.point))

    def _tell(self) -> None:
        """Show the draft."""
        draft = self.draft
        self._session.markers.draw(draft, start=bool(self._tool or draft.actions or draft.path))
        self._session.reveal_scene(shown=True)
        self._told.content = f"click: **{self._tool}**" if self._tool else "choose a button, then click in the picture"
        rows = [f"{number}. {drafts.described(step)}" for number, step in enumerate(draft.actions, 1)]
        self._list.content = "\n".join(rows) or "No steps yet."
        last = len(draft.steps) - 1
        step = draft.steps[last] if bool(self._drag.value) and last >= 0 else None
        self._gizmos.show(last, step if isinstance(step, Act) else None)

    def preview(self) -> None:
        """Show the poses of the steps where they will be held, each as a figure of its own."""
        acts = [step for step in self.draft.finished().steps if isinstance(step, Act)]
        if not acts:
            raise InvalidInputError("no pose yet: choose Sit, Grab or Joint and click in the picture")
        runtime = self._session.workshop.runtime

        def work(told: Told) -> list[tuple[str, Motion, str]]:
            found = []
            for number, act in enumerate(acts):
                told(number, len(acts), f"pose {number + 1}")
                found.append((act.name, runtime.pose(act.keypoints, act.heading).motion, "preview"))
            return found

        self._session.work("finding the poses", work, self._previewed)

    def _previewed(self, rows: list[tuple[str, Motion, str]], _: float) -> None:
        self._session.present(rows, world=True, made=False)

    def perform(self) -> None:
        """Let a character do it."""
        draft, scenery, speed = self.draft.finished(), self.scenery, float(self._speed.value)
        if not draft.steps:
            raise InvalidInputError("nothing to do yet: choose Walk, Sit or Grab and click in the picture")
        runtime = self._session.workshop.runtime

        def work(told: Told) -> Performance:
            return runtime.perform(
                scenery.scene if scenery else None,
                draft.steps,
                cloud=scenery.cloud if scenery else None,
                start=draft.start,
                speed=speed,
                seed=SEED,
                progress=told,
            )

        self._session.work("performing", work, self._performed)

    def _performed(self, performance: Performance, seconds: float) -> None:
        measures, motion = performance.measures, performance.motion
        words = [f"{motion.duration:.1f} s of motion in {seconds:.1f} s"]
        if measures.keypoint_max_cm is not None:
            words.append(f"keypoints missed by {measures.keypoint_max_cm:.1f} cm at most")
        if measures.off_path_m is not None:
            words.append(f"{100 * measures.off_path_m:.0f} cm off the path")
        self._report.content = "; ".join(words)
        self._session.present([("performance", motion, words[0])], world=True, dear=True)

    def script(self) -> str:
        """The draft as YAML."""
        draft, scenery = self.draft.finished(), self.scenery
        if not draft.steps:
            raise InvalidInputError("a script needs at least one step")
        spec, cloud = (scenery.spec, scenery.cloud_file) if scenery else (None, None)
        return script_text(draft.steps, draft.start, spec, cloud, speed=float(self._speed.value), seed=SEED)

    def download(self) -> None:
        """Hand the script over."""
        self._session.hand_over("script.yaml", self.script().encode())
