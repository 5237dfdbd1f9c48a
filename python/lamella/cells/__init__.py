"""Tissue files of label images: a picture of labels (picture), its walls as polygons that neighbours share (walls), and
tissue with borders for the solver (borders).

    python3 -m lamella.cells LABELS.tif -o tissue.json --pixel "0.65 um" --wall-thickness "2 um"

docs/reference/cells.md
"""
