"""Static files for motionrt-web: models, galleries and pages, written into a folder and served from one.

The TypeScript itself is in ``integrations/web``; nothing of it is needed to write the folder.
"""

from __future__ import annotations

from motionrt.web.folder import MODELS, write_folder
from motionrt.web.serving import page_server

__all__ = ["MODELS", "page_server", "write_folder"]
