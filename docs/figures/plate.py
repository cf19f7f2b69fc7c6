#!/usr/bin/env python3
"""Draws docs/figures/plate.png: the plate of the thesis after its last tear, by each criterion and both incisions.

    for c in maximum-principal maximum-shear von-mises maximum-hoop; do
      rhexis tear scenes/plate-tear.toml --set mesh.nodes=1270 --set fracture.strength=0.2e6 \\
          --set fracture.advance_threshold=0.15e6 --set fracture.criterion=$c --out out/figure/$c
    done
    rhexis tear scenes/plate-tear.toml --set mesh.nodes=1270 --set fracture.strength=0.2e6 \\
        --set fracture.advance_threshold=0.15e6 --set fracture.criterion=maximum-hoop \\
        --set fracture.incision=split --out out/figure/split
    docs/figures/plate.py out/figure/{maximum-principal,maximum-shear,von-mises,maximum-hoop,split}

Needs python3-h5py and python3-matplotlib.
"""

import glob
import json
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

FACES = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]
STRENGTH = 0.2e6  # Pa


def draw(axes, folder):
    with open(f"{folder}/summary.json") as file:
        summary = json.load(file)
    path = sorted(glob.glob(f"{folder}/steps/topology_*.vtkhdf"))[-1]
    with h5py.File(path) as file:
        grid = file["VTKHDF"]
        rest = grid["Points"][:]
        points = 1e3 * (rest + grid["PointData/displacement"][:])
        tets = grid["Connectivity"][:].reshape(-1, 4)
        cells = {name: grid[f"CellData/{name}"][:].ravel() for name in ("alive", "frozen", "local", "principal_max")}
    top = rest[:, 2] > rest[:, 2].max() - 1e-9
    polygons, colours, edges = [], [], []
    for t in np.flatnonzero(cells["alive"]):
        for face in FACES:
            nodes = tets[t][list(face)]
            if top[nodes].all():
                polygons.append(points[nodes, :2])
                stress = min(max(cells["principal_max"][t] / STRENGTH, 0.0), 1.0)
                colours.append("#b0b0b0" if cells["frozen"][t] else plt.cm.viridis(stress))
                edges.append("white" if cells["local"][t] else "#00000040")
    axes.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors=edges, linewidths=0.35))
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.axis("off")
    advances = sum(not advance["started"] for advance in summary["advances"])
    axes.set_title(f"{summary['criterion']}, {summary['incision']}\n{advances} advances", fontsize=9, color="#606060")


def main(folders):
    figure, axes = plt.subplots(1, len(folders), figsize=(3.1 * len(folders), 3.9))
    for one, folder in zip(np.atleast_1d(axes), folders):
        draw(one, folder)
    figure.tight_layout()
    # Transparent and without black text: it is read on light and on dark pages.
    figure.savefig("docs/figures/plate.png", dpi=110, transparent=True)


if __name__ == "__main__":
    main(sys.argv[1:])
