"""What is added to viser's page: a warning before unsaved work is left, and files that are dropped onto it."""

from __future__ import annotations

import gzip
from typing import Any

UNSAVED = "motionrt-unsaved"
"""The class of what is on the page for every clip that has not been saved."""

OPEN_BUTTON, OPEN_TAB = "Open clips, plans, projects", "Open"

SCRIPT = (
    """<script>
(() => {
  addEventListener("beforeunload", event => {
    if (document.querySelector(".UNSAVED")) { event.preventDefault(); event.returnValue = ""; }
  });
  const named = (kind, words) =>
    [...document.querySelectorAll(kind)].find(e => e.innerText.replace(/\\s+/g, " ").trim() === words);
  const field = () => {
    let box = named("button", "BUTTON");
    if (box && box.disabled) return null;  // it is being sent
    for (let step = 0; box && step < 4; step++, box = box.parentElement) {
      const found = box.querySelector("input[type=file]");
      if (found) return found;
    }
    return null;
  };
  const press = thing => ["pointerdown", "mousedown", "pointerup", "mouseup", "click"].forEach(kind => {
    const event = kind[0] == "p" ? PointerEvent : MouseEvent;
    thing.dispatchEvent(new event(kind, {bubbles: true, cancelable: true, button: 0}));
  });
  const soon = async (look, seconds) => {
    for (let left = 20 * seconds; left > 0; left--) {
      const found = look();
      if (found) return found;
      await new Promise(done => setTimeout(done, 50));
    }
    return null;
  };
  const open = async files => {
    if (!named("button", "BUTTON")) press(named("[role=tab]", "TAB"));
    for (const file of files) {
      const input = await soon(field, 60);
      if (!input) return;
      const one = new DataTransfer();
      one.items.add(file);
      input.files = one.files;
      input.dispatchEvent(new Event("change", {bubbles: true}));
      await new Promise(done => setTimeout(done, 400));
    }
  };
  const carries = event => event.dataTransfer && [...event.dataTransfer.types].includes("Files");
  addEventListener("dragover", event => { if (carries(event)) event.preventDefault(); }, true);
  addEventListener("drop", event => {
    if (carries(event) && named("[role=tab]", "TAB")) { event.preventDefault(); open([...event.dataTransfer.files]); }
  }, true);
})();
</script>""".replace("UNSAVED", UNSAVED)
    .replace("BUTTON", OPEN_BUTTON)
    .replace('"TAB"', f'"{OPEN_TAB}"')
)


def with_script(path: str, response: Any) -> Any:
    """A response with the script, if it is the page itself; any other as it is."""
    if path.partition("?")[0] not in {"/", "/index.html"} or response.status_code != 200:
        return response
    packed = response.headers.get("Content-Encoding") == "gzip"
    body = gzip.decompress(response.body) if packed else response.body
    head, mark, rest = body.partition(b"</head>")
    if mark:
        body = head + SCRIPT.encode() + mark + rest
        response.body = gzip.compress(body, 6) if packed else body
        if "Content-Length" in response.headers:
            del response.headers["Content-Length"]
            response.headers["Content-Length"] = str(len(response.body))
    return response
