import { significant } from "../base/format";

/** One key of the scene that may be set, as the program declares it for scenes, documentation and this page alike. */
export interface Declaration {
  readonly key: string; // "material.young"
  readonly kind: string; // of src/scene/declaration.h
  readonly unit: string; // SI; empty: none
  readonly min: number; // -Infinity: no bound
  readonly max: number;
  readonly choices: readonly string[];
  readonly doc: string;
}

type Json = null | boolean | number | string | readonly Json[] | { readonly [key: string]: Json };
const isObject = (value: Json | undefined): value is { readonly [key: string]: Json } =>
  typeof value === "object" && value !== null && !Array.isArray(value);
const textOr = (value: Json | undefined, otherwise: string): string => (typeof value === "string" ? value : otherwise);
const numberOr = (value: Json | undefined, otherwise: number): number => (typeof value === "number" ? value : otherwise);

function parse(json: string): Json {
  try {
    return JSON.parse(json) as Json;
  } catch {
    return null;
  }
}

/** Of Hello.declarations; what is not a declaration is left out. */
export function readDeclarations(json: string): Declaration[] {
  const entries = parse(json);
  if (!Array.isArray(entries)) return [];
  return (entries as readonly Json[]).filter(isObject).flatMap((entry) => {
    const key = textOr(entry["key"], "");
    if (key === "") return [];
    const choices = entry["choices"];
    return [{
      key,
      kind: textOr(entry["kind"], "text"),
      unit: textOr(entry["unit"], ""),
      min: numberOr(entry["min"], -Infinity),
      max: numberOr(entry["max"], Infinity),
      choices: Array.isArray(choices) ? (choices as readonly Json[]).filter((c) => typeof c === "string") : [],
      doc: textOr(entry["doc"], ""),
    }];
  });
}

/** Of Body.values: the present value of each key, as one types it. */
export function readValues(json: string): Map<string, string> {
  const values = parse(json);
  if (!isObject(values)) return new Map();
  return new Map(Object.entries(values).map(([key, value]) => [key, typed(value)]));
}

function typed(value: Json): string {
  if (typeof value === "string") return value;
  if (typeof value === "number") return numberText(value);
  return value === null ? "" : JSON.stringify(value);
}

/** As exact as it is, and with a power of ten where people write one: "1e6", but "2000". */
function numberText(value: number): string {
  const plain = String(value);
  if (Math.abs(value) < 1e5 && Math.abs(value) >= 1e-3) return plain;
  const power = value.toExponential().replace("e+", "e");
  return power.length < plain.length ? power : plain;
}

export type Form = "choice" | "switch" | "number" | "text";

export function formOf(declaration: Declaration): Form {
  if (declaration.choices.length > 0) return "choice";
  if (declaration.kind === "boolean") return "switch";
  return declaration.kind === "number" || declaration.kind === "integer" ? "number" : "text";
}

const isBounded = (declaration: Declaration): boolean =>
  Number.isFinite(declaration.min) && Number.isFinite(declaration.max);

/** A slider helps where its ends are near enough to each other that each step of it means something. */
export function hasSlider(declaration: Declaration): boolean {
  if (formOf(declaration) !== "number" || !isBounded(declaration)) return false;
  const largest = Math.max(Math.abs(declaration.min), Math.abs(declaration.max));
  return declaration.max > declaration.min && largest <= 1000;
}

/** "kg/m³" of "kg/m3". */
export const unitText = (unit: string): string => unit.replaceAll(/m2\b/g, "m²").replaceAll(/m3\b/g, "m³").replaceAll(/s2\b/g, "s²");

/** "0 to 0.5", "at least 3 Pa"; empty for every number. */
export function rangeText(declaration: Declaration): string {
  const unit = declaration.unit === "" ? "" : ` ${unitText(declaration.unit)}`;
  const { min, max } = declaration;
  if (isBounded(declaration)) return `${significant(min)} to ${significant(max)}${unit}`;
  if (Number.isFinite(min)) return `at least ${significant(min)}${unit}`;
  return Number.isFinite(max) ? `at most ${significant(max)}${unit}` : "";
}

/** What is wrong with what was typed, in words; empty: nothing that the page can tell. */
export function complaint(declaration: Declaration, typedText: string): string {
  const text = typedText.trim();
  if (text === "") return ""; // the key is left out, as by `--set key=`; whether it may be, the program knows
  if (declaration.kind === "number_or_auto" && text === "auto") return "";
  if (declaration.kind !== "number" && declaration.kind !== "integer" && declaration.kind !== "number_or_auto") return "";
  const value = Number(text);
  if (!Number.isFinite(value))
    return declaration.kind === "number_or_auto" ? "a number or auto is needed" : "a number is needed";
  if (declaration.kind === "integer" && !Number.isInteger(value)) return "a whole number is needed";
  if (value < declaration.min || value > declaration.max) return `it has to be ${rangeText(declaration)}`;
  return "";
}

/** The declarations by section, in their order: "material.young" stands under "material". */
export function bySection(declarations: readonly Declaration[]): Map<string, Declaration[]> {
  const sections = new Map<string, Declaration[]>();
  for (const declaration of declarations) {
    const dot = declaration.key.indexOf(".");
    const section = dot < 0 ? "scene" : declaration.key.slice(0, dot);
    sections.set(section, [...(sections.get(section) ?? []), declaration]);
  }
  return sections;
}

/** "advance_threshold" of "fracture.advance_threshold", readable. */
export const labelOf = (declaration: Declaration): string =>
  declaration.key.slice(declaration.key.indexOf(".") + 1).replaceAll("_", " ").replaceAll(".", " ");
