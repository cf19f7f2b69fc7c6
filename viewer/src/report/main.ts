/** Lets the shapes of a report be turned. It is put into the report as one script: see vite.report.config.ts. */

import * as THREE from "three";

import { kDark, kLight } from "../view/palette";
import { readShapes } from "./data";
import { ShapesFigure } from "./figure";

function start(): void {
  // Without WebGL this throws, and the pictures stand still as they are.
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // colours are those of the screen, as on the page
  THREE.ColorManagement.enabled = false;
  const figures: ShapesFigure[] = [];
  for (const place of document.querySelectorAll("figure.shapes")) {
    const data = place.querySelector('script[type="application/json"]')?.textContent;
    const turned = place.querySelector(".turned");
    if (!data || turned === null) continue;
    place.classList.add("live");
    figures.push(new ShapesFigure(renderer, turned, readShapes(data)));
  }
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const paint = (): void => figures.forEach((figure) => figure.paint(dark.matches ? kDark : kLight));
  dark.addEventListener("change", paint);
  paint();
}

start();
