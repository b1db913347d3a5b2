"""Export: the selected clip as a file, downloaded or saved in a folder."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from motionrt.studio.workshop import CHARACTER_FORMATS, character_bytes, file_name, formats, motion_bytes, save_in

if TYPE_CHECKING:
    from motionrt.studio.windows import StudioWindow


class ExportPanel:
    """The tab.

    Args:
        session: whose.
    """

    def __init__(self, session: StudioWindow) -> None:
        self._session = session
        gui, folder = session.client.gui, session.workshop.folder
        self._which: Any = gui.add_markdown("")
        self._form: Any = gui.add_dropdown("Format", formats())
        self._character: Any = gui.add_checkbox(
            "On your character", initial_value=False, visible=False, hint="In its own file, with its mesh"
        )
        self._character.on_update(session.guarded(lambda _: self._choose()))
        self._name: Any = gui.add_text("Name", initial_value="", hint="By default the name of the clip")
        download: Any = gui.add_button("Download", icon="download", color="blue")
        download.on_click(session.guarded(lambda _: self.download()))
        if folder is not None:
            save: Any = gui.add_button(
                f"Save in the folder {folder.name or folder}", icon="device-floppy", hint=str(folder)
            )
            save.on_click(session.guarded(lambda _: self.save()))

    def refresh(self) -> None:
        """After other clips came."""
        shown = [actor.clip for actor in self._session.stage.actors if actor.visible]
        self._which.content = f"selected: **{self._session.selected.name}**" if shown else "Nothing on the stage yet."

        character = self._session.stage.character
        if self._character.visible != (character is not None):
            self._character.visible = self._character.value = character is not None
            self._choose()

    def _choose(self) -> None:
        """A character has its own formats."""
        dressed = self._session.stage.character is not None and bool(self._character.value)
        self._form.options = CHARACTER_FORMATS if dressed else formats()
        self._form.value = self._form.options[0]

    def content(self) -> tuple[str, bytes]:
        """Name and bytes of the selected clip in the chosen format."""
        clip, form, character = self._session.selected, self._form.value, self._session.stage.character
        if character is not None and bool(self._character.value):
            name = file_name(self._name.value or f"{clip.name} {character.name}", form)
            return name, character_bytes(character, clip.motion, form)
        return file_name(self._name.value or clip.name, form), motion_bytes(clip.motion, form)

    def download(self) -> None:
        """Hand the file to the browser."""
        self._session.hand_over(*self.content())
        self._session.saved(self._session.selected)

    def save(self) -> None:
        """Write the file into the folder."""
        folder = self._session.workshop.folder
        if folder is not None:
            path = save_in(folder, *self.content())
            self._session.saved(self._session.selected)
            self._session.say("Saved", str(path))
