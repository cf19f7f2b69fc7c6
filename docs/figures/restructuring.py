#!/usr/bin/env python3
"""Prints the tables of ../restructuring.md from what `rhexis study restructuring` wrote.

    rhexis study restructuring --out out/restructuring && docs/figures/restructuring.py out/restructuring
"""
import json
import pathlib
import sys

WAYS = ("dense-inverse", "sparse", "local", "exact", "exact-all-work")


def number(value):
    if value >= 1000:
        return f"{value:,.0f}"
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def cells(rows, way, text):
    return text(rows[way]) if way in rows else ""


def line(*columns):
    print("| " + " | ".join(columns) + " |")


def main():
    rows = json.loads((pathlib.Path(sys.argv[1]) / "restructuring.json").read_text())
    for mode in ("slow-pull", "imposed"):
        print(f"\n{mode}\n")
        line("nodes (tets)", "tets, mm an advance", *WAYS, "sparse / exact", "sparse / exact-all-work")
        line("---", "---:", *["---:"] * 7)
        for nodes in sorted({row["nodes"] for row in rows}):
            here = {row["way"]: row for row in rows if row["nodes"] == nodes and row["mode"] == mode}
            if not here:
                continue
            first = here.get("exact", next(iter(here.values())))
            line(f"{nodes:,} ({first['mesh_tets']:,})", f"{first['tets_per_advance']:.0f}, {first['length_mm']:.1f}",
                 *[cells(here, way, lambda row: f"{number(row['ms_per_advance'])} ({number(row['ms_median'])})")
                   for way in WAYS],
                 *[cells(here, way, lambda row: number(row["sparse_over_this"])) for way in WAYS[3:]])
        print()
        line("nodes", *WAYS, "exact: re-mesh, local, update, wait", "most")
        line("---", *["---:"] * 7)
        for nodes in sorted({row["nodes"] for row in rows}):
            here = {row["way"]: row for row in rows if row["nodes"] == nodes and row["mode"] == mode}
            line(f"{nodes:,}", *[cells(here, way, lambda row: number(row["ms_per_tet"])) for way in WAYS],
                 cells(here, "exact", lambda row: ", ".join(
                     number(row[part]) for part in ("remesh_ms", "local_ms", "update_ms", "wait_ms"))),
                 cells(here, "exact", lambda row: number(row["ms_most"])))


if __name__ == "__main__":
    main()
