#!/usr/bin/env python3
"""Makes the fixtures of the reader tests with Gmsh, VTK and h5py, so that foreign programs are the oracle.

    make_fixtures.py      (in this folder; needs gmsh 4.8, VTK 9.1's Python modules, h5py, numpy)

Every file holds the same box. Arrays, for a point at (x, y, z) and cell number i of the file:
displacement = (x + 2y, 3z, -xyz), id = number of the point, lambda = i + 0.25, stress = 6 i .. 6 i + 5.
"""
import struct
import subprocess

import h5py
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

for name, options in {"gmsh22": ["msh22"], "gmsh41": ["msh41"], "gmsh22_binary": ["msh22", "-bin"],
                      "gmsh41_binary": ["msh41", "-bin"], "gmsh41_second_order": ["msh41", "-order", "2"]}.items():
    subprocess.run(["gmsh", "box.geo", "-3", "-v", "0", "-format", *options, "-o", f"box_{name}.msh"], check=True)


def sections(path):
    found, name = {}, None
    for line in open(path).read().splitlines():
        if line.startswith("$End"):
            name = None
        elif line.startswith("$"):
            name = line[1:]
            found[name] = []
        elif name:
            found[name].append(line)
    return found


def write_big_endian(version):
    """The text file again, in binary of the byte order that Gmsh does not write here."""
    text = sections(f"box_gmsh{version}.msh")
    out = open(f"box_gmsh{version}_big_endian.msh", "wb")
    out.write(f"$MeshFormat\n{version[0]}.{version[1]} 1 8\n".encode() + struct.pack(">i", 1) + b"\n$EndMeshFormat\n")
    out.write(("$PhysicalNames\n" + "\n".join(text["PhysicalNames"]) + "\n$EndPhysicalNames\n").encode())
    if version == "22":
        out.write(f"$Nodes\n{text['Nodes'][0]}\n".encode())
        for line in text["Nodes"][1:]:
            tag, *x = line.split()
            out.write(struct.pack(">i3d", int(tag), *map(float, x)))
        out.write(f"\n$EndNodes\n$Elements\n{text['Elements'][0]}\n".encode())
        for line in text["Elements"][1:]:
            number, kind, tags, *rest = map(int, line.split())
            out.write(struct.pack(f">{4 + len(rest)}i", kind, 1, tags, number, *rest))
        out.write(b"\n$EndElements\n")
        return
    entities = [line.split() for line in text["Entities"] if line]
    out.write(b"$Entities\n" + struct.pack(">4Q", *map(int, entities[0])))
    counts = list(map(int, entities[0]))
    for index, words in enumerate(entities[1:]):
        bounds = 3 if index < counts[0] else 6
        groups = int(words[1 + bounds])
        out.write(struct.pack(f">i{bounds}dQ{groups}i", int(words[0]), *map(float, words[1:1 + bounds]), groups,
                              *map(int, words[2 + bounds:2 + bounds + groups])))
        if bounds == 6:
            rest = list(map(int, words[2 + bounds + groups:]))
            out.write(struct.pack(f">Q{rest[0]}i", *rest))
    out.write(b"\n$EndEntities\n$Nodes\n")
    lines = iter(text["Nodes"])
    head = list(map(int, next(lines).split()))
    out.write(struct.pack(">4Q", *head))
    for _ in range(head[0]):
        block = list(map(int, next(lines).split()))
        out.write(struct.pack(">3iQ", *block))
        for _ in range(block[3]):
            out.write(struct.pack(">Q", int(next(lines))))
        for _ in range(block[3]):
            out.write(struct.pack(">3d", *map(float, next(lines).split())))
    out.write(b"\n$EndNodes\n$Elements\n")
    lines = iter(text["Elements"])
    head = list(map(int, next(lines).split()))
    out.write(struct.pack(">4Q", *head))
    for _ in range(head[0]):
        block = list(map(int, next(lines).split()))
        out.write(struct.pack(">3iQ", *block))
        for _ in range(block[3]):
            words = list(map(int, next(lines).split()))
            out.write(struct.pack(f">{len(words)}Q", *words))
    out.write(b"\n$EndElements\n")


write_big_endian("22")
write_big_endian("41")

lines = sections("box_gmsh22.msh")
points = np.array([list(map(float, line.split()[1:])) for line in lines["Nodes"][1:]])
elements = [list(map(int, line.split())) for line in lines["Elements"][1:]]
tets, triangles = [], []
for number, kind, tags, *rest in elements:
    nodes = [n - 1 for n in rest[tags:]]
    if kind == 4 and nodes not in tets:
        tets.append(nodes)
    if kind == 2 and nodes not in triangles:
        triangles.append(nodes)
# Triangles in between: values of cells have to follow the tets.
cells = tets[:3] + triangles + tets[3:]
types = [10] * 3 + [5] * len(triangles) + [10] * (len(tets) - 3)
n = len(cells)
x, y, z = points.T
point_data = {"displacement": np.stack([x + 2 * y, 3 * z, -x * y * z], axis=1), "id": np.arange(len(points), dtype=np.int32)}
cell_data = {"lambda": np.arange(n) + 0.25, "stress": np.arange(6 * n, dtype=np.float32).reshape(n, 6)}
connectivity = np.concatenate([np.array(c) for c in cells]).astype(np.int64)
offsets = np.concatenate([[0], np.cumsum([len(c) for c in cells])]).astype(np.int64)

grid = vtkUnstructuredGrid()
vtk_points = vtkPoints()
vtk_points.SetData(numpy_to_vtk(points, deep=True))
grid.SetPoints(vtk_points)
array = vtkCellArray()
array.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(connectivity, deep=True))
grid.SetCells(types, array)
for store, data in ((grid.GetPointData(), point_data), (grid.GetCellData(), cell_data)):
    for name, values in data.items():
        made = numpy_to_vtk(values, deep=True)
        made.SetName(name)
        store.AddArray(made)

for mode in ("Ascii", "Binary", "Appended"):
    for packed in (False, True):
        if mode == "Ascii" and packed:
            continue
        for variant, settings in {"": {}, "_wide": {"HeaderType": "UInt64"}, "_big_endian": {"ByteOrder": "BigEndian"},
                                  "_base64": {"EncodeAppendedData": True}}.items():
            if (variant == "_base64" and mode != "Appended") or (mode == "Ascii" and variant):
                continue
            writer = vtkXMLUnstructuredGridWriter()
            writer.SetInputData(grid)
            getattr(writer, f"SetDataModeTo{mode}")()
            writer.SetEncodeAppendedData(settings.get("EncodeAppendedData", False))
            if packed:
                writer.SetCompressorTypeToZLib()
                writer.SetBlockSize(512)
            else:
                writer.SetCompressorTypeToNone()
            if settings.get("HeaderType") == "UInt64":
                writer.SetHeaderTypeToUInt64()
            else:
                writer.SetHeaderTypeToUInt32()
            if settings.get("ByteOrder"):
                writer.SetByteOrderToBigEndian()
            writer.SetFileName(f"box_vtk_{mode.lower()}{'_zlib' if packed else ''}{variant}.vtu")
            writer.Write()

for version in (42, 51):
    for binary in (False, True):
        writer = vtkUnstructuredGridWriter()
        writer.SetInputData(grid)
        writer.SetFileVersion(version)
        writer.SetFileType(2 if binary else 1)
        writer.SetFileName(f"box_vtk{version}{'_binary' if binary else ''}.vtk")
        writer.Write()

for variant, options in {"": {}, "_chunked": {"chunks": True, "compression": "gzip", "shuffle": True, "fletcher32": True}}.items():
    with h5py.File(f"box_h5py{variant}.vtkhdf", "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = [1, 0]
        root.attrs.create("Type", "UnstructuredGrid".encode("ascii"), dtype=h5py.string_dtype("ascii", 16))
        for name, values in {"NumberOfPoints": [len(points)], "NumberOfCells": [n],
                             "NumberOfConnectivityIds": [len(connectivity)]}.items():
            root.create_dataset(name, data=np.array(values, dtype=np.int64))
        root.create_dataset("Points", data=points.astype(">f8" if variant else "f8"), **options)
        root.create_dataset("Connectivity", data=connectivity.astype(np.int32), **options)
        root.create_dataset("Offsets", data=offsets)
        root.create_dataset("Types", data=np.array(types, dtype=np.uint8))
        for group, data in (("PointData", point_data), ("CellData", cell_data)):
            made = root.create_group(group)
            for name, values in data.items():
                made.create_dataset(name, data=values)
