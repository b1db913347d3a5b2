"""Tiny networks on one thread: threads that wait for each other cost more than they bring on a busy machine."""

from __future__ import annotations

import pytest

torch = pytest.importorskip("torch", reason='torch is not installed: pip install "motionrt[train]"')
torch.set_num_threads(1)
