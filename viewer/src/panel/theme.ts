import { byId, setText } from "./dom";

type Choice = "auto" | "light" | "dark";
const kChoices: readonly Choice[] = ["auto", "light", "dark"];
const kKey = "rhexis.theme";

/** Light, dark, or as the system has it. */
export class Theme {
  private readonly button = byId("theme-button", HTMLButtonElement);
  private readonly system = matchMedia("(prefers-color-scheme: dark)");
  private choice: Choice = readChoice();

  constructor(private readonly changed: (isDark: boolean) => void) {
    this.button.addEventListener("click", () => this.next());
    this.system.addEventListener("change", () => this.apply());
    this.apply();
  }

  get isDark(): boolean {
    return this.choice === "dark" || (this.choice === "auto" && this.system.matches);
  }

  private next(): void {
    this.choice = kChoices[(kChoices.indexOf(this.choice) + 1) % kChoices.length] ?? "auto";
    try {
      localStorage.setItem(kKey, this.choice);
    } catch {
      // A browser that keeps nothing: the choice lasts as long as the page.
    }
    this.apply();
  }

  private apply(): void {
    document.documentElement.dataset["theme"] = this.isDark ? "dark" : "light";
    setText(this.button, `Theme: ${this.choice}`);
    this.button.setAttribute("aria-label", `Theme: ${this.choice}. Press to change`);
    this.changed(this.isDark);
  }
}

function readChoice(): Choice {
  try {
    const kept = localStorage.getItem(kKey);
    return kChoices.find((choice) => choice === kept) ?? "auto";
  } catch {
    return "auto";
  }
}
