#!/usr/bin/env python3
"""Solves real vessels and organs with every model and prints the table of docs/real-bodies.md.

    tools/real_bodies.py DATA OUT [--bodies vessel_solid_401 kidney_5k] [--models corotated hyperelastic]

DATA holds NAME.msh or NAME.msh.gz. Each run is one `rhexis solve`; its scene stays in OUT.
"""

import argparse
import json
import pathlib
import subprocess

MODELS = ["mass-spring", "linear", "corotated", "geometrically-nonlinear", "hyperelastic", "taylor-hood"]
LARGEST_TAYLOR_HOOD = 5100  # nodes

# Arteries: the upper cut of the aorta and both renal cuts are held, the lower cut is pulled by 5 N down and 1 N aside.
VESSEL = """
[material]
density = 1060.0
young = 1.0e6
poisson = 0.49
{supports}
[[traction]]
set = "aorta_inferior"
force = [1.0, -5.0, 0.0]
"""
# Organs: a cap is held, the opposite one moved aside by a tenth of the body's box and out by a twentieth.
ORGAN = """
[sets.held]
box = {{ from = [0.0, 0.0, 0.0], to = [1.0, 0.1, 1.0] }}
[sets.grasped]
box = {{ from = [0.0, 0.92, 0.0], to = [1.0, 1.0, 1.0] }}
[material]
density = 1060.0
young = {young}
poisson = 0.49
[[support]]
set = "held"
x = 0.0
y = 0.0
z = 0.0
[[support]]
set = "grasped"
x = "10%"
y = "5%"
z = 0.0
"""
HELD_CUT = '[[support]]\nset = "{}"\nx = 0.0\ny = 0.0\nz = 0.0\n'


def vessel():
    return VESSEL.format(supports="".join(HELD_CUT.format(cut) for cut in ("aorta_superior", "renal_left", "renal_right")))


BODIES = {
    "vessel_solid_401": vessel(),
    "vessel_solid_3k": vessel(),
    "vessel_wall_30k": vessel(),
    "kidney_5k": ORGAN.format(young="1.0e4"),
    "liver_5k": ORGAN.format(young="2.0e4"),
}


def scene(name, mesh, model, body, linear):
    return (
        f'title = "{name}, {model}"\ngravity = [0.0, -9.81, 0.0]\n[mesh]\nfile = "{mesh}"\n{body}'
        f'[model]\nkind = "{model}"\n'
        + ('beta = "auto"\n' if model == "hyperelastic" else "")
        + f'[solver]\nlinear = "{linear}"\nsteps = 4\n'
    )


def run(command, data, out, name, model, linear):
    mesh = next(path for path in (data / f"{name}.msh", data / f"{name}.msh.gz") if path.exists())
    file = out / f"{name}-{model}.toml"
    file.write_text(scene(name, mesh.resolve(), model, BODIES[name], linear))
    process = subprocess.run([command, "solve", file, "--out", out / f"{name}-{model}", "--json", "--quiet"], capture_output=True, text=True)
    if not process.stdout:
        return {"error": process.stderr.strip()}
    return json.loads(process.stdout)


def row(name, model, linear, result):
    if "error" in result:
        return f"| {name} | {model} | {linear} | {result['error']} | | | | | |"
    outcome = "converged" if result["converged"] else f"no, at {result['load']:.3f}: {result['why'].split(': ', 1)[-1]}"
    return (
        f"| {name} | {model} | {linear} | {outcome} | {sum(result['iterations'])} | {result['unknowns']} | {1e3 * result['max_displacement']:.2f} "
        f"| {result['volume_ratio']:.5f} | {result['time']['total']:.1f} | {result['memory']['peak'] / 1e6:.0f} |"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--bodies", nargs="+", default=list(BODIES))
    parser.add_argument("--models", nargs="+", default=MODELS)
    parser.add_argument("--command", default="build/release/bin/rhexis")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    print("| body | model | linear solver | converged | iterations | unknowns | largest displacement, mm | volume ratio | time, s | peak memory, MB |")
    print("| --- | --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    for name in arguments.bodies:
        nodes = 30000 if name.endswith("30k") else 5000
        for model in arguments.models:
            if model == "taylor-hood" and nodes > LARGEST_TAYLOR_HOOD:
                continue
            # The saddle system is where the condensed conjugate gradients pay.
            linear = "cg" if model == "hyperelastic" else "direct"
            print(row(name, model, linear, run(arguments.command, arguments.data, arguments.out, name, model, linear)), flush=True)


if __name__ == "__main__":
    main()
