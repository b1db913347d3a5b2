"""Headless Chromium by its DevTools protocol: no package needed but websockets, which viser brings."""

from __future__ import annotations

import base64
import json
import os
import shutil
import subprocess
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

PATIENCE = float(os.environ.get("MOTIONRT_PATIENCE", "1"))
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--use-gl=angle",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-default-apps",
    "--disable-extensions",
    "--mute-audio",
    "--disable-background-timer-throttling",
    "--disable-renderer-backgrounding",
    "--disable-backgrounding-occluded-windows",
    "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1",
    "--remote-debugging-port=0",
)


def find_chromium() -> str | None:
    """The program, if there is one."""
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


class Page:
    """A tab.

    Args:
        address: of its DevTools socket.
    """

    def __init__(self, address: str) -> None:
        from websockets.sync.client import connect

        self._socket = connect(address, max_size=None, open_timeout=20, ping_interval=None)
        self._number = 0
        self.events: list[dict[str, Any]] = []
        self.dialogs: list[str] = []
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """One command of the protocol, and its result."""
        self._number += 1
        asked = self._number
        self._socket.send(json.dumps({"id": asked, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.recv(timeout=240))
            if answer.get("id") == asked:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return dict(answer["result"])
            self.events.append(answer)
            if answer.get("method") == "Page.javascriptDialogOpening":  # "leave this page?" waits for an answer
                self.dialogs.append(answer["params"]["type"])
                self._number += 1
                self._socket.send(
                    json.dumps(
                        {"id": self._number, "method": "Page.handleJavaScriptDialog", "params": {"accept": True}}
                    )
                )

    def run(self, script: str) -> Any:
        """The value of a JavaScript expression."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(str(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def wait(self, script: str, seconds: float = 40) -> Any:
        """Until an expression is true."""
        return wait_until(lambda: self.run(script), seconds, script)

    def text(self) -> str:
        """All the text on the page."""
        return str(self.run("document.body ? document.body.innerText : ''"))

    def wait_text(self, text: str, seconds: float = 40) -> None:
        """Until the page says something."""
        wait_until(lambda: text in self.text(), seconds, f"the text {text!r}; the page says: {self.text()[-1500:]}")

    def middle(self, find: str) -> tuple[float, float]:
        """The middle, in pixels, of the element that an expression finds, scrolled into view, at rest, uncovered."""
        script = (
            f"(() => {{ const e = {find}; if (!e) return null; const at = () => {{ const r = e.getBoundingClientRect();"
            " return [r.x + r.width / 2, r.y + r.height / 2]; }; e.scrollIntoView({block: 'center'}); const a = at();"
            " return new Promise(done => setTimeout(() => { const b = at(), over = document.elementFromPoint(...b);"
            " done(a[0] == b[0] && a[1] == b[1] && over && (e.contains(over) || over.contains(e)) ? b : null); }, 80));"
            " })()"
        )
        x, y = self.wait(script)
        return x, y

    def click_at(self, x: float, y: float) -> None:
        """A real click."""
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.call(
                "Input.dispatchMouseEvent",
                type=kind,
                x=x,
                y=y,
                button="none" if kind == "mouseMoved" else "left",
                buttons=int(kind == "mousePressed"),
                clickCount=int(kind != "mouseMoved"),
            )
            time.sleep(0.05)

    def click(self, text: str) -> None:
        """Click the button, tab or label with a text."""
        self.call("Page.bringToFront")
        self.click_at(*self.middle(element(text)))

    def tab(self, name: str) -> None:
        """Open a tab of the panel; again, if the page was not ready for the click."""
        selected = f"(e => e && e.getAttribute('aria-selected') === 'true')({element(name)})"

        def opened() -> bool:
            self.click(name)
            time.sleep(0.3)
            return bool(self.run(selected))

        wait_until(opened, 60, f"the tab {name}")

    def fill(self, label: str, text: str) -> None:
        """Write into the field with a label, and press Enter."""
        self.wait(f"(e => e ? (e.focus(), e.select(), true) : false)({field(label)})")
        self.call("Input.insertText", text=text)
        self.press("Enter")

    def press(self, key: str) -> None:
        """One key."""
        code = {"Enter": 13, " ": 32, "ArrowLeft": 37, "ArrowRight": 39}.get(key, ord(key[0].upper()))
        for kind in ("keyDown", "keyUp"):
            self.call(
                "Input.dispatchKeyEvent",
                type=kind,
                key=key,
                windowsVirtualKeyCode=code,
                code=f"Key{key.upper()}" if key.isalpha() and len(key) == 1 else key,
                **({"text": "\r"} if key == "Enter" and kind == "keyDown" else {}),
            )

    def screenshot(self, file: Path | None = None) -> bytes:
        """The page as PNG."""
        png = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        if file is not None:
            file.write_bytes(png)
        return png

    def close(self) -> None:
        """Close the tab, whatever the page has to say about it."""
        self.run("addEventListener('beforeunload', event => event.stopImmediatePropagation(), true)")
        self.call("Page.close")
        self._socket.close()

    def requests(self) -> list[str]:
        """Addresses that the page asked for."""
        self.run("1")
        return [e["params"]["request"]["url"] for e in self.events if e["method"] == "Network.requestWillBeSent"]


def element(text: str) -> str:
    """The smallest clickable element that shows a text, as JavaScript."""
    return (
        "[...document.querySelectorAll('button, [role=tab], label, [role=option], a, input[type=checkbox]')]"
        f".filter(e => e.offsetParent !== null && e.innerText.replace(/\\s+/g, ' ').includes({json.dumps(text)}))"
        ".sort((a, b) => a.innerText.length - b.innerText.length)[0]"
    )


def field(label: str) -> str:
    """The input in the row of a label, as JavaScript."""
    return (
        "(() => { const l = [...document.querySelectorAll('label, p, div')].filter(e => e.offsetParent !== null &&"
        f" e.innerText.trim() === {json.dumps(label)}).pop(); let e = l;"
        " for (let i = 0; e && i < 6; i++) { const f = e.querySelector('input, textarea'); if (f) return f;"
        " e = e.parentElement; } return null; })()"
    )


class Browser:
    """A running browser.

    Args:
        port: of its DevTools.
    """

    def __init__(self, port: int) -> None:
        self.port = port

    def open(self, address: str, width: int = 1000, height: int = 640, scale: float = 1.0) -> Page:
        """A new tab with a page; a smaller ``scale`` has fewer pixels, which software rendering is grateful for."""
        asked = urllib.request.Request(f"http://127.0.0.1:{self.port}/json/new?about:blank", method="PUT")
        with urllib.request.urlopen(asked, timeout=20) as answer:
            page = Page(json.load(answer)["webSocketDebuggerUrl"])
        page.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=False
        )
        page.call("Page.navigate", url=address)
        return page


@contextmanager
def browser(folder: Path, *flags: str) -> Iterator[Browser]:
    """Chromium with a fresh profile in a folder, and further flags."""
    program = find_chromium()
    assert program is not None
    profile = folder / "profile"
    with (folder / "chromium.log").open("wb") as log:
        started = subprocess.Popen(
            [program, *FLAGS, *flags, f"--user-data-dir={profile}", "about:blank"], stdout=log, stderr=log
        )
        try:
            told = profile / "DevToolsActivePort"
            wait_until(lambda: told.is_file() and told.read_text().strip(), 30, "Chromium")
            yield Browser(int(told.read_text().split()[0]))
        finally:
            started.terminate()
            try:
                started.wait(10)
            except subprocess.TimeoutExpired:
                started.kill()


def wait_until(true: Callable[[], Any], seconds: float, what: str) -> Any:
    """Wait for something to become true, and return it; ``MOTIONRT_PATIENCE`` times as long on a busy machine."""
    end = time.monotonic() + seconds * PATIENCE
    while time.monotonic() < end:
        found = true()
        if found:
            return found
        time.sleep(0.12)
    raise TimeoutError(f"waited {seconds} s for {what}")
