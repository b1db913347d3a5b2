"""The page of a perceptual study in headless Chromium, from a file, without a network."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from chromium import Browser
from motions import walking

from motionrt.study import Pair, count_votes, write_study


@pytest.fixture
def page_file(tmp_path: Path) -> Path:
    walk = walking(45, fps=30).grounded()
    pairs = [Pair(name, walk, walk[:30]) for name in ("one", "two", "three", "four")]
    return write_study(pairs, tmp_path / "study.html", names=("ours", "theirs"))


def test_votes_are_counted_in_random_order_without_names(chromium: Browser, page_file: Path, tmp_path: Path) -> None:
    page = chromium.open(page_file.as_uri())
    try:
        page.wait_text("1 of 4")
        assert "ours" not in page.text()
        inked = "document.getElementById('left').getContext('2d').getImageData(0,0,400,300).data.some(v => v)"
        page.wait(inked)
        page.click("the left one")
        page.wait_text("2 of 4")
        for _ in range(3):
            page.click("the right one")
        page.wait_text("Thank you.")
        saved = json.loads(page.run("JSON.stringify(result())"))
        assert sorted(vote["pair"] for vote in saved["votes"]) == ["four", "one", "three", "two"]
        assert saved["votes"][0]["chosen"] == saved["votes"][0]["left"]
        assert all(vote["chosen"] != vote["left"] for vote in saved["votes"][1:])
        file = tmp_path / "votes.json"
        file.write_text(json.dumps(saved))
        count = count_votes([file])
        assert (count.share, count.low, count.high) == pytest.approx((saved["share"], saved["low"], saved["high"]))
        assert page.run("table()").splitlines()[0] == "pair,left,chosen,seconds"
        assert [address for address in page.requests() if not address.startswith(("file:", "blob:", "data:"))] == []
    finally:
        page.close()


def test_order_and_sides_are_drawn_anew(chromium: Browser, page_file: Path) -> None:
    page = chromium.open(page_file.as_uri())
    try:
        page.wait_text("1 of 4")
        drawn = page.run("Array.from({length: 40}, () => { begin(); return JSON.stringify(order); })")
        assert len(set(drawn)) > 20
    finally:
        page.close()
