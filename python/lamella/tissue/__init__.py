"""Irregular tissue: files of cells as polygons (file.Tissue), and tissue that is made by its statistics (make.make)."""
from .file import Tissue

__all__ = ["Tissue"]
