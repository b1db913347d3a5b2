// A character for a game's loop: stands, sets off when it is given a goal, walks, stops there, and acts on the spot.
import { poseBetween, matricesOf, type Motion } from "./motion";
import { wrapped } from "./rotations";
import type { Sessions } from "./sessions";
import { JOINTS } from "./skeleton";
import { Crowd, type Frame, type Goal, SPEED, standingAt, strideAt } from "./walking";

const THERE = 0.35; // metres from the goal at which the character stops
const FADE = 12; // frames over which it sets off, stops, or passes into an action
const TURN = 0.09; // radians a frame that the aim of the walk may turn: nobody spins on his heel at full speed
const ROOT = JOINTS * 9;

type State = "stands" | "walks" | "acts";

export class Stroller {
  state: State = "stands";
  private goal: Goal | null = null;
  private readonly steering: Steering;
  private readonly crowd: Crowd;
  private action: Frame[] = [];
  private from: Frame; // the pose that is faded out of
  private faded = FADE;
  private last: Frame;

  constructor(sessions: Sessions, place: Goal, public speed = SPEED) {
    this.crowd = new Crowd(sessions, [strideAt(place)]);
    this.last = this.from = standingAt(place);
    this.steering = new Steering(place.heading);
  }

  get place(): Goal {
    return { x: this.last[ROOT], z: this.last[ROOT + 2], heading: facing(this.last) };
  }

  /** Walk there from the next frame on. */
  walkTo(x: number, z: number): void {
    const here = this.place;
    this.goal = { x, z, heading: Math.atan2(x - here.x, z - here.z) };
    if (this.state === "walks" || this.distance() < THERE) return;
    this.steering.heading = here.heading;
    this.crowd.histories = [strideAt({ x: here.x, z: here.z, heading: here.heading })];
    this.fadeTo("walks");
  }

  /** Play a motion here; afterwards it stands. */
  act(motion: Motion): void {
    const here = this.place;
    const placed = motion.canonical().placed(here.heading, [here.x, 0, here.z]);
    this.action = Array.from({ length: placed.frames }, (_, f) => placed.frame(f));
    this.goal = null;
    this.fadeTo("acts");
  }

  /** The next frame, 1/30 s on. */
  async step(): Promise<Frame> {
    const next = await this.next();
    if (this.faded < FADE) {
      this.faded++;
      const share = this.faded / FADE;
      this.last = mixed(this.from, next, share * share * (3 - 2 * share));
    } else this.last = next;
    return this.last;
  }

  private async next(): Promise<Frame> {
    if (this.state === "acts") {
      const frame = this.action.shift();
      if (frame) return frame;
      this.fadeTo("stands");
    }
    if (this.state === "walks" && this.goal) {
      if (this.distance() > THERE) return (await this.crowd.step([this.steering.aim(...this.crowd.place(0), this.goal)], this.speed))[0];
      this.goal = null;
      this.fadeTo("stands");
    }
    return standingAt({ x: this.from[ROOT], z: this.from[ROOT + 2], heading: facing(this.from) });
  }

  private fadeTo(state: State): void {
    this.state = state;
    this.from = this.last;
    this.faded = 0;
  }

  private distance(): number {
    return this.goal ? Math.hypot(this.goal.x - this.last[ROOT], this.goal.z - this.last[ROOT + 2]) : 0;
  }
}

/** Turns a character round to its goal bit by bit; WalkNet is given points of the way that leads there. */
export class Steering {
  constructor(public heading: number) {}

  /** What to give WalkNet so that somebody at (x, z) gets to a place. */
  aim(x: number, z: number, goal: { x: number; z: number }): Goal {
    const wanted = Math.atan2(goal.x - x, goal.z - z);
    this.heading += Math.max(-TURN, Math.min(TURN, wrapped(wanted - this.heading)));
    if (Math.abs(wrapped(wanted - this.heading)) < 0.05) return { x: goal.x, z: goal.z, heading: wanted };
    return { x: x + Math.sin(this.heading), z: z + Math.cos(this.heading), heading: this.heading };
  }
}

/** Yaw of a frame's pelvis. */
export function facing(frame: ArrayLike<number>): number {
  return Math.atan2(frame[2], frame[8]);
}

function mixed(a: Frame, b: Frame, weight: number): Frame {
  const { quaternions, root } = poseBetween(a, b, weight);
  const out = new Float64Array(ROOT + 3);
  out.set(matricesOf(quaternions));
  out.set(root, ROOT);
  return out;
}
