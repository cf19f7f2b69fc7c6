#!/usr/bin/env python3
"""Draws docs/figures/vessel.png: lambda on the deformed vessel with beta = 0, beta = auto and taylor-hood.

    for b in 0 auto; do rhexis solve scenes/vessel.toml --set model.beta=$b --out out/figure/beta-$b; done
    rhexis solve scenes/vessel.toml --set model.kind=taylor-hood --set model.beta= --out out/figure/taylor-hood
    docs/figures/vessel.py out/figure/beta-0 out/figure/beta-auto out/figure/taylor-hood

Needs python3-h5py and python3-matplotlib.
"""

import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

TITLES = ["beta = 0", "beta = auto", "Taylor-Hood"]
LIMITS = (0.0, 0.2)  # MPa
FACES = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]


def surface(folder):
    """Deformed boundary triangles in mm and lambda of their tets in MPa."""
    with h5py.File(f"{folder}/result.vtkhdf") as file:
        grid = file["VTKHDF"]
        points = 1e3 * (grid["Points"][:] + grid["PointData/displacement"][:])
        tets = grid["Connectivity"][:].reshape(-1, 4)
        lam = 1e-6 * grid["CellData/lambda"][:].ravel()
    faces = {}
    for t, tet in enumerate(tets):
        for face in FACES:
            nodes = tuple(tet[list(face)])
            key = tuple(sorted(nodes))
            if key in faces:
                faces[key] = None
            else:
                faces[key] = (nodes, t)
    kept = [entry for entry in faces.values() if entry is not None]
    return points[np.array([nodes for nodes, _ in kept])], lam[[t for _, t in kept]]


def main():
    figure = plt.figure(figsize=(9.6, 5.2))
    colours = plt.get_cmap("viridis")
    for i, folder in enumerate(sys.argv[1:4]):
        axes = figure.add_subplot(1, 3, i + 1, projection="3d")
        triangles, lam = surface(folder)
        normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        light = 0.65 + 0.35 * np.clip(normal @ np.array([0.3, -0.8, 0.52]), -1, 1)
        rgb = colours((lam - LIMITS[0]) / (LIMITS[1] - LIMITS[0]))[:, :3] * light[:, None]
        axes.add_collection3d(Poly3DCollection(triangles, facecolors=np.clip(rgb, 0, 1), edgecolors=(0, 0, 0, 0.15), linewidths=0.3))
        axes.set(xlim=(-9, 15), ylim=(-12, 12), zlim=(-13, 41), title=TITLES[i])
        axes.set_box_aspect((24, 24, 54), zoom=1.35)
        axes.view_init(elev=12, azim=-70)
        axes.set_axis_off()
    bar = figure.colorbar(plt.cm.ScalarMappable(plt.Normalize(*LIMITS), colours), ax=figure.axes, shrink=0.6, extend="both")
    bar.set_label("mean stress lambda, MPa")
    figure.savefig("docs/figures/vessel.png", dpi=130, facecolor="white", bbox_inches="tight")


if __name__ == "__main__":
    main()
