"""Search: a text, ranked hits, the best of them playing."""

from __future__ import annotations

import html
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.notebook import strip
from motionrt.studio.jobs import Told

if TYPE_CHECKING:
    from motionrt.retrieval import Hit
    from motionrt.studio.windows import StudioWindow

HITS, PLAYED = 10, 3
PICTURED, STRIP = 5, 4  # hits with a picture, and the poses of each
EXAMPLE = "a person walks in a circle"
Row = tuple[str, Motion, str]


class SearchPanel:
    """The tab.

    Args:
        session: whose.
    """

    def __init__(self, session: StudioWindow) -> None:
        self._session = session
        gui = session.client.gui
        with gui.add_form(None) as form:
            self._text: Any = gui.add_text("Text", initial_value=EXAMPLE)
        go: Any = gui.add_button("Find", icon="search", color="blue")
        self._played: Any = gui.add_slider("Play the best", 1, 6, 1, PLAYED)
        self._keep: Any = gui.add_checkbox("Add to stage", initial_value=False, hint="Keep what is there")
        self._folder: Any = gui.add_folder("Hits", visible=False)
        self._rows: list[Any] = []
        form.on_submit(session.guarded(lambda _: self.search()))
        go.on_click(session.guarded(lambda _: self.search()))

    def search(self) -> None:
        """Ask the gallery; the best hits play."""
        text = self._text.value.strip()
        if not text:
            raise InvalidInputError(f"write what to look for, as in: {EXAMPLE}")
        shop, played = self._session.workshop, int(self._played.value)

        def work(_: Told) -> tuple[list[Hit], list[Row]]:
            hits = shop.runtime.retrieve(text, HITS, shop.gallery)
            if not hits:
                raise InvalidInputError(hits.notice or "the gallery has no such motion")
            gallery = shop.runtime.gallery(shop.gallery)
            return hits, [_row(hit, gallery.motion(hit)) for hit in hits[: max(played, PICTURED)]]

        def done(found: tuple[list[Hit], list[Row]], seconds: float) -> None:
            hits, rows = found
            self._list(hits, rows, seconds)
            self._session.present(rows[:played], keep=bool(self._keep.value), made=False)

        self._session.work(f"searching for “{text}”", work, done)

    def play(self, hit: Hit) -> None:
        """Play one hit."""
        motion = self._session.workshop.runtime.gallery(self._session.workshop.gallery).motion(hit)
        self._session.present([_row(hit, motion)], keep=bool(self._keep.value), made=False)

    def _list(self, hits: list[Hit], rows: list[Row], seconds: float) -> None:
        for row in self._rows:
            row.remove()
        gui = self._session.client.gui
        with self._folder:
            self._rows = [gui.add_markdown(f"{len(hits)} hits in {1000 * seconds:.0f} ms; click one to play it")]
            for number, hit in enumerate(hits):
                self._rows.append(self._button(hit))
                self._rows.append(gui.add_html(card(hit, rows[number][1] if number < len(rows) else None)))
        self._folder.visible = True

    def _button(self, hit: Hit) -> Any:
        hint = f"{hit.id}, {hit.start_s:.1f} to {hit.end_s:.1f} s, score {hit.score:.3f}"
        button = self._session.client.gui.add_button(label(hit), hint=hint, color="gray")
        button.on_click(self._session.guarded(lambda _: self.play(hit)))
        return button


def label(hit: Hit) -> str:
    """What stands on the button of a hit; its words, which may be long, stand below."""
    return f"Play {hit.rank} · score {hit.score:.2f}"


def card(hit: Hit, motion: Motion | None) -> str:
    """HTML below the button of a hit: its words, how long it is, where it lies, and a strip of poses."""
    folder = Path(hit.id).parent.as_posix()
    facts = (f"{hit.end_s - hit.start_s:.1f} s", folder if folder != "." else "")
    said = html.escape(" · ".join(fact for fact in facts if fact))
    words = f'<div>{html.escape(name_of(hit))} <span style="opacity:0.7">· {said}</span></div>'
    drawn = "" if motion is None else f'<div style="zoom:0.62;margin-top:0.6em">{strip(motion, STRIP)}</div>'
    style = "padding:0 0.8em 0.5em;font-size:0.8em;line-height:1.3;overflow-wrap:anywhere"
    return f'<div style="{style}">{words}{drawn}</div>'


def _row(hit: Hit, motion: Motion) -> Row:
    note = f"rank {hit.rank} · score {hit.score:.2f} · {hit.start_s:.1f}–{hit.end_s:.1f} s"
    return name_of(hit), motion.canonical(), note


def name_of(hit: Hit) -> str:
    """What a clip is called on the page: its words, or the name of its file."""
    return hit.text or Path(hit.id).stem
