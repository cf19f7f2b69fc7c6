import { subtract, type Vec3 } from "../base/vec3";
import type { Hit } from "../body/pick";
import type { Command, State } from "../protocol/messages";

/** ms that the program has to answer a Grasp with a State that holds, before its silence counts as a refusal. */
const kAnswerTime = 1500;

/**
 * The page's hand on the body, whatever moves it: a pointer, keys, a controller. Says what the program has to hear, and
 * notices when the program lets go by itself.
 */
export class Grip {
  private from: Vec3 | null = null; // m, where the point was when it was taken
  private isAnswered = false;
  private takenAt = 0; // ms
  private moved: Vec3 = [0, 0, 0];

  /** `lost`: the program let go, or never held. */
  constructor(
    private readonly send: (command: Command) => void,
    private readonly lost: (wasHeld: boolean) => void,
    private readonly now: () => number = () => performance.now(),
  ) {}

  get isHolding(): boolean {
    return this.from !== null;
  }

  /** m, of the hand since it took hold. */
  get displacement(): Vec3 {
    return this.moved;
  }

  /** `push`: the point gives way where the hand presses, and does not follow it back. */
  take(hit: Hit, push: boolean): void {
    if (this.isHolding) this.letGo();
    this.from = hit.point;
    this.moved = [0, 0, 0];
    this.isAnswered = false;
    this.takenAt = this.now();
    this.send({ kind: "grasp", face: hit.face, weights: hit.weights, push });
  }

  /** `to`: m, where the hand is now, in the scene. */
  moveTo(to: Vec3): void {
    if (this.from === null) return;
    this.moveBy(subtract(to, this.from));
  }

  /** `by`: m, from where it took hold. */
  moveBy(by: Vec3): void {
    if (this.from === null || !by.every(Number.isFinite)) return;
    this.moved = by;
    this.send({ kind: "move", to: by });
  }

  letGo(): void {
    if (this.from === null) return;
    this.from = null;
    this.send({ kind: "letGo" });
  }

  /** Of each State: whether it still holds what is thought to be held. */
  hear(state: State): void {
    if (this.from === null) return;
    if (state.held) {
      this.isAnswered = true;
      return;
    }
    // The first States after a Grasp are older than it.
    if (!this.isAnswered && (state.paused || this.now() - this.takenAt < kAnswerTime)) return;
    this.drop();
  }

  /** The connection, the role or the body is gone. */
  drop(): void {
    if (this.from === null) return;
    this.from = null;
    this.lost(this.isAnswered);
  }
}
