"""Draws a tissue file as a label image, in place of a micrograph that a program has segmented:

    python3 draw_labels.py TISSUE.json LABELS.png WIDTH HEIGHT PIXEL

width and height in pixels, the edge of a pixel in the unit of the file. Periodic images are cells of their own; air
is 0.
"""
import sys

import numpy as np
from matplotlib.path import Path
from PIL import Image

from lamella.plot.rest import outlines
from lamella.tissue import Tissue

tissue, (width, height), pixel = Tissue.read(sys.argv[1]), map(int, sys.argv[3:5]), float(sys.argv[5])
points, first = outlines(tissue, None)[0], tissue.edges.first
middles = (np.stack(np.meshgrid(np.arange(width), np.arange(height)[::-1]), axis=-1).reshape(-1, 2) + 0.5) * pixel
labels = np.zeros(width * height, np.uint8)
for i, j in np.ndindex(3, 3):
    for cell in range(len(tissue.cells)):
        around = points[first[cell]:first[cell + 1]].reshape(-1, 2) + (i - 1, j - 1) @ tissue.period
        inside = Path(around).contains_points(middles)
        if inside.any():
            labels[inside] = labels.max() + 1
Image.fromarray(labels.reshape(height, width)).save(sys.argv[2])
