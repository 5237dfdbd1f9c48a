"""Irregular tissue: files of cells as polygons (file), and tissue that is made by its statistics (make)."""
from .file import Tissue

__all__ = ["Tissue"]
