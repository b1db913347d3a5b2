"""motionrt-web as it is built, and the folder that it loads; skipped, with the reason, where it is not built."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import motionrt
from motionrt.web import write_folder

ROOT = Path(__file__).parents[3]
PACKAGE = ROOT / "integrations" / "web"
BUILD = "in integrations/web: npm install && npm run build && npm run demo"

Ask = Callable[..., Any]


@pytest.fixture(scope="session")
def package() -> Path:
    if shutil.which("node") is None:
        pytest.skip("needs Node.js")
    if not (PACKAGE / "dist" / "lib" / "index.js").is_file():
        pytest.skip(f"motionrt-web is not built ({BUILD})")
    return PACKAGE


@pytest.fixture(scope="session")
def runtime() -> motionrt.Runtime:
    return motionrt.Runtime(threads=1, text_tower="full")


@pytest.fixture(scope="session")
def site(package: Path, runtime: motionrt.Runtime, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_folder(tmp_path_factory.mktemp("site"), {"starter": runtime.gallery()})


@pytest.fixture(scope="session")
def ask(package: Path, site: Path, tmp_path_factory: pytest.TempPathFactory) -> Ask:
    folder = tmp_path_factory.mktemp("node")
    (folder / "node_modules").mkdir()
    (folder / "node_modules" / "motionrt-web").symlink_to(package)
    script = folder / "checks.mjs"
    shutil.copy(Path(__file__).with_name("checks.mjs"), script)

    def run(job: str, **given: Any) -> Any:
        asked = json.dumps({"job": job, "site": str(given.pop("site", site)), **given})
        done = subprocess.run(
            ["node", str(script)], input=asked, capture_output=True, text=True, encoding="utf-8", check=False
        )
        assert done.returncode == 0, done.stderr
        assert done.stderr == ""  # no warnings
        return json.loads(done.stdout)

    return run
