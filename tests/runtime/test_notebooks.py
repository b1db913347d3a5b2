"""What objects look like at a prompt and in a notebook."""

from __future__ import annotations

import pickle
import re
import xml.etree.ElementTree as ET
from copy import copy
from dataclasses import replace
from pathlib import Path

import numpy as np
from fake_embedder import open_fake
from motions import standing, walking
from tiny_models import TINY

from motionrt import Runtime
from motionrt.locomotion.path import Path as WalkPath
from motionrt.locomotion.path import Waypoints
from motionrt.locomotion.walk import Walk
from motionrt.motion.notebook import strip, table
from motionrt.retrieval import Hits, build_gallery, find
from motionrt.retrieval.finding import Search


def test_a_strip_is_svg_with_a_figure_a_pose_inside_its_cell() -> None:
    drawn = ET.fromstring(strip(walking(60), poses=5))
    texts = [element.text for element in drawn.iter() if element.tag.endswith("text")]
    assert texts == ["0.0 s", "0.8 s", "1.5 s", "2.2 s", "3.0 s"]
    lines = [element for element in drawn.iter() if element.tag.endswith("line")]
    assert len(lines) == 5 * 23
    width, height = float(drawn.attrib["width"]), float(drawn.attrib["height"])
    ends = np.array([[float(line.attrib[name]) for name in ("x1", "y1", "x2", "y2")] for line in lines])
    assert (ends >= 0).all()
    assert (ends[:, ::2] <= width).all()
    assert (ends[:, 1::2] <= height).all()


def test_left_is_on_the_right_of_a_figure_that_looks_at_the_reader() -> None:
    drawn = ET.fromstring(strip(standing()))
    blue, red = (
        np.mean([float(e.attrib["x2"]) for e in drawn.iter() if e.attrib.get("stroke") == colour])
        for colour in ("#2f7bc8", "#c8452f")
    )
    assert blue > red


def test_cells_are_escaped() -> None:
    assert "<script>" not in table(["<script>"], [["<script>alert(1)</script>"]])


def test_motions_and_walks_say_in_a_line_what_they_are() -> None:
    motion = walking(60)
    assert "<svg" in motion._repr_html_()
    path = WalkPath(np.array([[0.0, 0.0], [0.0, 3.0]]))
    waypoints = Waypoints(np.array([[0, 1], [0, 2], [0, 3]], np.float32), np.zeros(3, np.float32))
    walk = Walk(replace(motion, fps=30.0), path, waypoints, 0.4, np.zeros(60))
    assert repr(walk) == "Walk(3.00 m in 2.00 s, 3 waypoints)"
    assert "<svg" in walk._repr_html_()
    assert "foot skate" in walk._repr_html_()


def test_a_runtime_says_which_models_it_has_and_which_are_open() -> None:
    assert repr(Runtime()) == "Runtime(the models that come with motionrt; open: none yet)"


def test_a_runtime_shows_its_models_as_a_table() -> None:
    shown = Runtime(TINY)._repr_html_()
    assert shown.count("<tr>") > 3
    assert "tmr_motion" in shown
    assert "MB" in shown


def test_a_hit_is_copied_and_pickled_without_the_gallery_that_it_was_found_in(tmp_path: Path) -> None:
    walking(60).save(tmp_path / "walk.bvh")
    gallery = build_gallery(tmp_path, open_fake).gallery
    hit = find(gallery, "walk", open_fake().embed_text(["walk"])[0], Search(anyway=True))[0]
    for twin in (pickle.loads(pickle.dumps(hit)), copy(hit), replace(hit)):
        assert twin == hit
        assert "<svg" not in twin._repr_html_()
        assert "walk.bvh" in twin._repr_html_()


def test_hits_and_galleries_show_pictures_and_survive_files_that_are_gone(tmp_path: Path) -> None:
    walking(60).save(tmp_path / "<b>walk.bvh")
    gallery = build_gallery(tmp_path, open_fake).gallery
    hits = find(gallery, "walk", open_fake().embed_text(["walk"])[0], Search(anyway=True))
    assert re.fullmatch(r"Hit\(1, -?[\d.]+, '<b>walk.bvh', 0.0-3.0 s\)", repr(hits[0]))
    for shown in (gallery._repr_html_(), hits._repr_html_(), hits[0]._repr_html_()):
        assert "<svg" in shown
        assert "<b>" not in shown
    (tmp_path / "<b>walk.bvh").unlink()
    assert "<svg" not in hits._repr_html_()
    assert "<svg" not in hits[0]._repr_html_()
    assert "<table>" in Hits()._repr_html_()
