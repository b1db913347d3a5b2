"""Open: motion files, bundles and projects of the user's, and the project of this window to save."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.errors import InvalidInputError, MotionRTError
from motionrt.formats import MOTION_SUFFIXES, Character, animations_of, load_motion
from motionrt.studio.clips import Clip
from motionrt.studio.layout import AS_RECORDED, LAYOUTS
from motionrt.studio.project import PLAN, SCRIPT, SHEET, project_bytes, sheet_of, unpacked
from motionrt.studio.scenery import SCRIPT_SUFFIXES
from motionrt.studio.showing import checked_character

if TYPE_CHECKING:
    from motionrt.studio.windows import StudioWindow

OURS = "motionrt's figure"
INVITATION = """\
**Begin with any of these**

* **Search** the library: the text that stands there works
* **Make** motion of words, or **Plan** several in a row
* **Direct** a character with clicks in the picture
* **Open** your own files, and your own character below
"""


class OpenPanel:
    """The tab.

    Args:
        session: whose.
    """

    def __init__(self, session: StudioWindow) -> None:
        self._session = session
        gui, guarded = session.client.gui, session.guarded
        upload: Any = gui.add_upload_button("Open clips, plans, projects", icon="upload", hint=_hint())
        self._keep: Any = gui.add_checkbox("Add to stage", initial_value=True, hint="Keep what is there")
        self._invitation: Any = gui.add_markdown(INVITATION)
        with gui.add_folder("Your own character"):
            figure: Any = gui.add_upload_button("Open a character (.glb, .vrm)", icon="user", hint="With its mesh")
            self._figure: Any = gui.add_dropdown("Seen is", (OURS,), initial_value=OURS)
            self._characters: dict[str, Character] = {}
        save: Any = gui.add_button("Download as project", icon="device-floppy", hint="Clips, script, scene and plan")
        undo: Any = gui.add_button("Undo", icon="arrow-back-up", hint="Key Z")
        gui.add_markdown("Work is kept for an hour: after a reload it is here again. To keep it longer, save it.")
        upload.on_upload(guarded(lambda _: self.uploaded(upload.value.name, upload.value.content)))
        figure.on_upload(guarded(lambda _: self.dress(figure.value.name, figure.value.content)))
        self._figure.on_update(guarded(lambda _: session.set_character(self._characters.get(self._figure.value))))
        save.on_click(guarded(lambda _: self.save()))
        undo.on_click(guarded(lambda _: session.undo()))

    def refresh(self, *, empty: bool) -> None:
        """After other clips came: the invitation is for those who have none."""
        self._invitation.visible = empty
        character = self._session.stage.character
        if character is not None:
            self._characters[character.name] = character
        options = (OURS, *self._characters)
        if tuple(self._figure.options) != options:
            self._figure.options = options
        self._figure.value = OURS if character is None else character.name

    def dress(self, name: str, content: bytes) -> None:
        """See all clips on a character of the user's own.

        Raises:
            InvalidInputError, RigError, FormatError: it cannot be used; says what to do.
        """
        file = self._session.uploads.keep(name, content)
        with self._session.uploads.alone():
            character = checked_character(file)
        self._session.set_character(character)
        self._session.say("Your character is on the stage", "Export puts motion on it, too")

    def save(self) -> None:
        """Hand the project over.

        Raises:
            InvalidInputError: there is nothing to save.
        """
        state = self._session.state()
        if state.empty:
            raise InvalidInputError("there is nothing to save yet")
        self._session.hand_over("project.zip", project_bytes(state))
        self._session.saved(*state.clips)

    def uploaded(self, name: str, content: bytes) -> None:
        """Open a file of the user's: a clip, a plan, a scene, a script, or a ZIP of all of these."""
        suffix = Path(name).suffix.lower()
        if suffix == ".zip":
            self._open_bundle(content)
        elif suffix in MOTION_SUFFIXES:
            file = self._session.uploads.keep(name, content)
            with self._session.uploads.alone():
                self._session.present(self._rows(file, Path(name).stem), keep=bool(self._keep.value), saved=True)
        else:
            self._session.open_scene(name, content)

    def _open_bundle(self, content: bytes) -> None:
        files, uploads = unpacked(content), self._session.uploads
        sheet = sheet_of(files)
        kept = {name: uploads.keep(name, body) for name, body in files if name != SHEET}
        with uploads.alone():
            if sheet is None:
                self._open_files(kept)
            else:
                self._open_project(sheet, kept)

    def _open_files(self, kept: dict[str, Path]) -> None:
        rows, problems = [], []
        for name, file in kept.items():
            if file.suffix.lower() in MOTION_SUFFIXES:
                try:
                    rows += self._rows(file, Path(name).stem)
                except MotionRTError as error:
                    problems.append(str(error))
        if rows:
            self._session.present(rows, keep=bool(self._keep.value), saved=True)
        for problem in problems:
            self._session.complain(problem)
        scripts = [file for file in kept.values() if file.suffix.lower() in SCRIPT_SUFFIXES]
        if not rows and not scripts:
            raise InvalidInputError("; ".join(problems) or "the ZIP holds no motion, script or plan")
        for script in scripts[:1]:
            self._session.open_script(script)

    def _open_project(self, sheet: dict[str, Any], kept: dict[str, Path]) -> None:
        clips = self._clips_of(sheet, kept)
        wanted = kept.get(str(sheet.get("character")))
        character = None if wanted is None else checked_character(wanted)
        self._session.before_losing([], lambda stay: self._take_project(sheet, kept, [*stay, *clips], character))

    def _clips_of(self, sheet: dict[str, Any], kept: dict[str, Path]) -> list[Clip]:
        clips: list[Clip] = []
        for row in sheet["clips"]:
            file = kept.get(str(row["file"]))
            if file is None:
                raise InvalidInputError(f"the project lacks its file {row['file']}")
            name, note = str(row.get("name", file.stem))[:80], str(row.get("note", ""))[:200]
            clips.append(self._session.clip(name, load_motion(file), clips, note=note))
        return clips

    def _take_project(
        self, sheet: dict[str, Any], kept: dict[str, Path], clips: list[Clip], character: Character | None
    ) -> None:
        session = self._session
        session.remember()
        with session.uploads.alone():  # again: the user may have been asked in between
            if SCRIPT in kept:
                session.open_script(kept[SCRIPT])
            if PLAN in kept:
                session.open_plan(kept[PLAN])
        session.set_character(character)
        layout = str(sheet.get("layout"))
        session.put_clips(clips, layout if layout in LAYOUTS else AS_RECORDED)
        session.saved(*clips)

    def _rows(self, file: Path, name: str) -> list[Any]:
        several = animations_of(file)
        if not several:
            return [(name, load_motion(file), "opened")]
        return [(f"{name} {which}", load_motion(file, animation=which), "opened") for which in several]


def _hint() -> str:
    return f"{', '.join(MOTION_SUFFIXES)}; a plan; or a .zip of several, of a script with its scene, of a project"
