"""Projects: everything that a window holds, as one file to save and to open again.

A project is a ZIP of plain files: ``project.json``, the clips as ``.npz``, ``script.yaml`` and ``plan.yaml``, and the
files of the scene. A ZIP without ``project.json`` is a bundle: clips, a script with its scene, a plan, as they are.
"""

from __future__ import annotations

import io
import json
import re
import tempfile
import zipfile
from pathlib import Path
from typing import Any

from motionrt.errors import InvalidInputError
from motionrt.limits import how_to_raise, limits
from motionrt.motion import Motion
from motionrt.studio.script_text import script_text
from motionrt.studio.state import State
from motionrt.untrusted.names import plain_stem
from motionrt.untrusted.npz import BROKEN

SHEET, SCRIPT, PLAN = "project.json", "script.yaml", "plan.yaml"
_MOST = 100  # files of a bundle
_VERSION = 1


def project_bytes(state: State) -> bytes:
    """The content of a project file."""
    out = io.BytesIO()
    draft, scenery = state.draft.finished(), state.scenery
    spec, cloud = (scenery.spec, scenery.cloud_file) if scenery is not None else (None, None)
    files = [file for file in (spec.file if spec is not None else None, cloud) if file is not None and file.is_file()]
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        rows = []
        for number, clip in enumerate(state.clips):
            name = f"clip{number}.npz"
            archive.writestr(name, _npz(clip.motion))
            rows.append({"file": name, "name": clip.name, "note": clip.note, "made": clip.made})
        if draft.steps or scenery is not None:
            text = script_text(draft.steps, draft.start, spec, cloud)
            for file in files:
                archive.writestr(file.name, file.read_bytes())
                text = text.replace(str(file.resolve()), file.name)
            archive.writestr(SCRIPT, text)
        if state.plan.lines:
            archive.writestr(PLAN, state.plan.text())
        sheet = {"version": _VERSION, "layout": state.layout, "clips": rows}
        if state.character is not None and state.character.content:
            sheet["character"] = f"character-{plain_name(state.character.file.name)}"
            archive.writestr(str(sheet["character"]), state.character.content)
        archive.writestr(SHEET, json.dumps(sheet, ensure_ascii=True, indent=1))
    return out.getvalue()


def unpacked(content: bytes) -> list[tuple[str, bytes]]:
    """Plain names and contents of the files of a project or bundle, without its folders.

    Raises:
        InvalidInputError: no ZIP, a damaged one, too many or too large files, or two of one name.
    """
    found: dict[str, bytes] = {}
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = [member for member in archive.infolist() if not member.filename.endswith("/")]
            members = [member for member in members if not _hidden(member.filename)]
            _check(members)
            for member in members:
                name = plain_name(member.filename)
                if name in found:
                    raise InvalidInputError(f"the ZIP holds two files '{name}'; give them other names")
                with archive.open(member) as packed:
                    found[name] = packed.read(member.file_size + 1)
    except InvalidInputError:
        raise
    except BROKEN as error:
        raise InvalidInputError(f"no ZIP file that can be read: {error}") from error
    return list(found.items())


def sheet_of(files: list[tuple[str, bytes]]) -> dict[str, Any] | None:
    """What the ``project.json`` among files says; None where there is none.

    Raises:
        InvalidInputError: it is damaged, or of a newer motionrt.
    """
    from motionrt.untrusted import json_text

    content = dict(files).get(SHEET)
    if content is None:
        return None
    sheet = json_text.parse(content, lambda reason, _: InvalidInputError(f"{SHEET} {reason}"))
    clips = sheet.get("clips") if isinstance(sheet, dict) else None
    if not isinstance(clips, list) or any(not isinstance(row, dict) or "file" not in row for row in clips):
        raise InvalidInputError(f"{SHEET} is no sheet of a project")
    if sheet.get("version") != _VERSION:
        raise InvalidInputError(f"the project is of another version of motionrt ({sheet.get('version')!r})")
    return dict(sheet)


def plain_name(name: str) -> str:
    """The last part of a path, in letters that every file system takes."""
    last = Path(name.replace("\\", "/").rpartition("/")[2])
    stem = plain_stem(last.stem.encode("ascii", "replace").decode()) or "file"
    return stem + re.sub(r"[^.\w]", "", last.suffix, flags=re.ASCII)[:10].rstrip(".")


def _check(members: list[zipfile.ZipInfo]) -> None:
    if len(members) > _MOST:
        raise InvalidInputError(f"the ZIP holds {len(members)} files; {_MOST} are enough")
    total = sum(member.file_size for member in members)
    if total > limits().unpacked_bytes:
        raise InvalidInputError(f"the ZIP unpacks to {total:,} bytes: {how_to_raise('unpacked_bytes')}")


def _hidden(name: str) -> bool:
    """What systems put into archives beside the user's files."""
    return "__MACOSX" in name or name.replace("\\", "/").rpartition("/")[2].startswith(".")


def _npz(motion: Motion) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        return motion.save(Path(folder) / "clip.npz").read_bytes()
