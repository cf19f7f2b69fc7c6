/** The element of index.html with this id. Throws where page and program of the page do not fit each other. */
export function byId<T extends HTMLElement>(id: string, kind: new () => T): T {
  const element = document.getElementById(id);
  if (!(element instanceof kind)) throw new Error(`index.html has no ${kind.name} '${id}'`);
  return element;
}

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: readonly (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** Writes only what differs: a text that is written anew is laid out, and read out, anew. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** Names and values that change in place. */
export class Facts {
  private readonly values = new Map<string, HTMLElement>();

  constructor(private readonly list: HTMLElement) {}

  set(name: string, value: string, title = ""): void {
    let element = this.values.get(name);
    if (element === undefined) {
      element = make("dd");
      this.list.append(make("div", { title }, make("dt", { textContent: name }), element));
      this.values.set(name, element);
    }
    setText(element, value);
  }
}
