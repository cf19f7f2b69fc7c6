import { Grip } from "./hand/grip";
import { Headset } from "./hand/headset";
import { Keyboard } from "./hand/keyboard";
import { Pointer } from "./hand/pointer";
import { AdvancesTable } from "./panel/advances_table";
import { ComparisonPanel } from "./panel/comparison_panel";
import { byId, make, setText } from "./panel/dom";
import { ForcePanel } from "./panel/force_panel";
import { ForcePlot } from "./panel/force_plot";
import { Legend } from "./panel/legend";
import { LoopsPanel } from "./panel/loops_panel";
import { Messages } from "./panel/messages";
import { ScenePanel } from "./panel/scene_panel";
import { StatusBar } from "./panel/status_bar";
import { Theme } from "./panel/theme";
import { TimelineBar } from "./panel/timeline_bar";
import { Transport } from "./panel/transport";
import { TrialPanel } from "./panel/trial_panel";
import { describe, describeWait, kFirstLink, liveAddress, type Link } from "./protocol/connection";
import type { Command, ServerFrame } from "./protocol/messages";
import { LiveSocket, type Listener } from "./protocol/socket";
import { kFields } from "./colour/scale";
import { Store, type Change, type Event } from "./session/store";
import { troubles, type Trouble } from "./session/troubles";
import { exposeDebugHandle } from "./debug";
import { Shortcuts } from "./shortcuts";
import { kDark, kLight } from "./view/palette";
import { Stage } from "./view/stage";
import { Level, Presented } from "./wire/rhexis_generated";

/** ms between two looks at what needs no frame to change: the count down to the next attempt, the replay's clock. */
const kTickEvery = 250;

const kPresented: Readonly<Record<Presented, string>> = { [Presented.sample]: "the sample", [Presented.a]: "A", [Presented.b]: "B" };

/** The page: frames go into the store, what they changed is shown, what a person does becomes commands. */
export class App implements Listener {
  private readonly canvas = byId("picture", HTMLCanvasElement);
  private readonly store = new Store((event) => this.tell(event));
  private readonly socket = new LiveSocket(liveAddress(location), this);
  private readonly send = (command: Command): void => this.socket.send(command);
  private readonly stage = new Stage(this.canvas, this.store);
  private readonly grip = new Grip(this.send, (wasHeld) => this.loseGrip(wasHeld));
  private readonly messages = new Messages();
  private readonly status = new StatusBar(this.send, () => this.socket.tryNow());
  private readonly force = new ForcePanel();
  private readonly plot = new ForcePlot(byId("force-plot", HTMLDivElement));
  private readonly comparison = new ComparisonPanel(this.send);
  private readonly legend = new Legend();
  private readonly scene = new ScenePanel(this.send);
  private readonly advances = new AdvancesTable();
  private readonly loops = new LoopsPanel();
  private readonly transport = new Transport(this.send, () => this.store.state);
  private readonly timeline = new TimelineBar(this.send);
  private readonly trial = new TrialPanel((command) => this.decide(command), () => this.store.trial);
  private readonly field = byId("field", HTMLSelectElement);
  private readonly hint = byId("hint", HTMLParagraphElement);
  private readonly keyboard = this.makeKeyboard();
  private readonly headset: Headset;
  private link: Link = kFirstLink;
  private pictures = 0;
  private asked = ""; // of an experiment
  private isShowDue = false;

  constructor() {
    const mayHold = (): boolean => this.mayHold();
    new Pointer(this.canvas, this.stage, this.store.surface, this.grip, mayHold);
    this.headset = new Headset(this.stage, this.store.surface, this.grip, mayHold, (isOn) => this.showHeadset(isOn));
    new Theme((isDark) => this.paint(isDark));
    this.stage.onDrawn = () => this.countPicture();
    this.bindChoices();
    this.bindKeys();
    void this.offerHeadset();
    exposeDebugHandle(this.store, this.stage, () => this.link, () => this.pictures);
    setInterval(() => this.tick(), kTickEvery);
  }

  start(): void {
    this.socket.start();
  }

  // ---- what comes over the wire

  frame(frame: ServerFrame): void {
    const change = this.store.take(frame);
    if (frame.kind === "notice" && frame.notice.level !== Level.info) {
      this.scene.restore();
      this.comparison.restore();
    }
    this.react(change);
  }

  linked(link: Link): void {
    const before = this.link;
    this.link = link;
    if (before.kind === "open" && link.kind !== "open") {
      if (!this.isOver) this.tell({ level: Level.error, text: "Connection lost" });
      this.grip.drop();
    }
    if (before.kind === "connecting" && before.wasOpen && link.kind === "open")
      this.tell({ level: Level.info, text: "Connected again" });
    this.canvas.classList.toggle("stale", link.kind !== "open" && this.store.body !== null);
    this.status.showLink(link);
    this.requestShow();
    this.tick();
  }

  garbled(why: string): void {
    this.tell({ level: Level.error, text: `A frame could not be read: ${why}` });
  }

  private react(change: Change): void {
    const { store } = this;
    switch (change) {
      case "hello":
        if (store.hello !== null) this.scene.hear(store.hello);
        this.timeline.isHidden = !(store.hello?.replay ?? false);
        this.transport.isHidden = store.hello?.replay ?? false;
        break;
      case "role":
        if (!store.hasHand) this.grip.drop();
        break;
      case "body":
        if (store.body !== null) this.scene.show(store.body);
        if (this.headset.isOn) this.headset.placeBody();
        // Often it is the same body sent again, so it is not drawn before the State that says how it is deformed, and
        // the hand is only given up when that State does not hold.
        return;
      case "state":
        if (store.state !== null) this.grip.hear(store.state);
        break;
      case "trial":
        this.meetTrial();
        break;
      case "timeline":
        if (store.timeline !== null) this.timeline.hear(store.timeline);
        break;
      case "recorded":
        this.messages.showRecordings(store.recordings);
        this.tell({ level: Level.info, text: "A recording can be downloaded" });
        break;
      case "edit":
      case "event":
      case "pong":
      case "none":
        break;
    }
    if (change === "none" || change === "pong") return;
    this.stage.requestDraw();
    this.requestShow();
  }

  /** An experiment that is over: the program ends with it, and is not missed. */
  private get isOver(): boolean {
    return this.store.trial?.finished ?? false;
  }

  /** Another plate is felt, or another trial: what was held is not, any more. */
  private meetTrial(): void {
    const { trial } = this.store;
    if (trial === null) return;
    this.transport.isHidden = true;
    const asked = `${trial.number} ${trial.presented} ${trial.finished}`;
    if (asked === this.asked) return;
    this.asked = asked;
    setText(byId("title", HTMLSpanElement), trial.title);
    this.messages.say(trial.finished ? "The experiment is over" : `Trial ${trial.number}: ${kPresented[trial.presented]}`);
  }

  // ---- what is shown

  /** Texts change at most once a picture, however many frames come. */
  private requestShow(): void {
    if (this.isShowDue) return;
    this.isShowDue = true;
    requestAnimationFrame(() => {
      this.isShowDue = false;
      this.show();
    });
  }

  private show(): void {
    const { store, stage } = this;
    const mayAct = this.link.kind === "open" && store.hasHand;
    this.force.show(store.state);
    this.trial.show(mayAct);
    this.comparison.show(store.body, store.state, mayAct, store.hello?.replay ?? false);
    this.plot.show(store.trace, store.own, store.compared, store.advances.map((advance) => advance.time), store.body?.maxForce ?? 0);
    this.loops.show(store.state?.rates ?? null, this.socket.roundTrip);
    this.advances.show(store.advances);
    // The scene's own cracks, of time 0, are not taken back.
    this.transport.show(mayAct, (store.body?.script ?? 0) > 0, store.advances.some((advance) => advance.time > 0));
    this.scene.isEnabled = mayAct;
    this.timeline.isEnabled = mayAct;
    this.field.disabled = !mayAct;
    this.status.showRole(this.link.kind === "open" ? store.role : null, store.hello);
    this.legend.show(stage.kind, stage.scale);
    if (store.state !== null && document.activeElement !== this.field) this.field.value = String(store.state.field);
    setText(this.hint, this.hintText());
    this.showTroubles();
  }

  private showTroubles(): void {
    const found: Trouble[] = troubles(this.store);
    const lost = describe(this.link);
    const detail = describeWait(this.link, (this.socket.nextAttempt - performance.now()) / 1000);
    // A page that has just been opened is not in trouble yet.
    const isLate = this.link.kind !== "connecting" || this.link.wasOpen || this.link.attempt > 0;
    if (this.isOver) return this.messages.showTroubles([]);
    if (lost !== "" && isLate) this.messages.showTroubles([{ id: "link", level: Level.error, text: lost, detail }]);
    else this.messages.showTroubles(lost === "" ? found : []);
  }

  private hintText(): string {
    if (this.store.body === null) return "";
    if (this.store.hello?.replay) return "A recording. Drag to turn, wheel to come nearer";
    if (this.grip.isHolding || this.store.state?.held) return "";
    if (this.store.trial !== null) return this.mayHold() ? "Drag the plate along the arrow" : "";
    return this.mayHold() ? "Drag the body to pull it. Space runs the script" : "Drag to turn, wheel to come nearer";
  }

  private tick(): void {
    this.timeline.tick();
    if (this.link.kind !== "open") this.showTroubles();
  }

  private paint(isDark: boolean): void {
    this.stage.paint(isDark ? kDark : kLight);
    this.plot.repaint();
  }

  private countPicture(): void {
    this.pictures += 1;
    // The scale of the colours is found while the picture is made.
    this.legend.show(this.stage.kind, this.stage.scale);
  }

  private tell(event: Event): void {
    this.messages.tell({ level: event.level, text: event.text.charAt(0).toUpperCase() + event.text.slice(1) });
  }

  // ---- what a person does

  private mayHold(): boolean {
    return this.link.kind === "open" && this.store.hasHand && !(this.store.hello?.replay ?? false) && this.store.state !== null;
  }

  /** Of an experiment: what is held is let go of before another plate is felt. */
  private decide(command: Command): void {
    this.grip.letGo();
    this.send(command);
  }

  private loseGrip(wasHeld: boolean): void {
    this.canvas.classList.remove("holding");
    const text = wasHeld ? "The hand was let go" : "The point could not be held";
    this.tell({ level: Level.warning, text });
  }

  private bindChoices(): void {
    this.field.append(make("option", { value: "0", textContent: "Local object white, the rest grey" }));
    this.field.append(...kFields.map((kind) => make("option", { value: String(kind.field), textContent: kind.name })));
    this.field.addEventListener("change", () => this.send({ kind: "showField", field: Number(this.field.value) }));
    const lines = byId("mesh-lines", HTMLInputElement);
    lines.addEventListener("change", () => (this.stage.showsLines = lines.checked));
    const help = byId("help", HTMLDialogElement);
    byId("help-button", HTMLButtonElement).addEventListener("click", () => help.showModal());
  }

  private bindKeys(): void {
    const isReplay = (): boolean => this.store.hello?.replay ?? false;
    const live = (act: () => void) => (): void => (isReplay() || this.store.trial !== null ? undefined : act());
    new Shortcuts({
      " ": () => (isReplay() ? this.timeline.toggle() : live(() => this.transport.toggleScript())()),
      r: live(() => this.send({ kind: "reset" })),
      u: live(() => this.send({ kind: "undo" })),
      p: live(() => this.transport.togglePause()),
      s: live(() => this.transport.stepOn()),
      "1": () => this.trial.feel(Presented.sample),
      "2": () => this.trial.feel(Presented.a),
      "3": () => this.trial.feel(Presented.b),
      a: () => this.trial.answer(Presented.a),
      b: () => this.trial.answer(Presented.b),
    });
    this.canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey) return;
      if (this.keyboard.press(event.key, event.shiftKey, event.altKey)) event.preventDefault();
    });
    this.canvas.addEventListener("focus", () => this.canvas.matches(":focus-visible") && this.keyboard.begin());
    this.canvas.addEventListener("blur", () => this.keyboard.end());
  }

  private makeKeyboard(): Keyboard {
    const { stage, store, grip } = this;
    return new Keyboard({
      rig: stage.rig,
      surface: store.surface,
      grip,
      mayHold: () => this.mayHold(),
      showCursor: (at) => stage.marks.showCursor(at),
      requestDraw: () => stage.requestDraw(),
      fit: () => stage.fit(),
      say: (text) => this.messages.say(text),
    });
  }

  private async offerHeadset(): Promise<void> {
    const button = byId("headset-button", HTMLButtonElement);
    button.hidden = !(await Headset.isThere());
    button.addEventListener("click", () => {
      const done = this.headset.isOn ? this.headset.exit() : this.headset.enter();
      done.catch((error: unknown) => this.tell({ level: Level.error, text: `The headset: ${String(error)}` }));
    });
  }

  private showHeadset(isOn: boolean): void {
    setText(byId("headset-button", HTMLButtonElement), isOn ? "Leave VR" : "Enter VR");
  }
}
