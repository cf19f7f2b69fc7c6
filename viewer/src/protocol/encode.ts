import * as flatbuffers from "flatbuffers";

import type { Vec3 } from "../base/vec3";
import * as wire from "../wire/rhexis_generated";
import type { Command } from "./messages";

const vec3 = (v: Vec3): wire.Vec3T => new wire.Vec3T(v[0], v[1], v[2]);

/** A filled object of the schema, and the number of its kind. */
export type Payload = readonly [wire.Payload, wire.FrameT["payload"]];

export function encodePayload([kind, payload]: Payload): Uint8Array {
  const builder = new flatbuffers.Builder(256);
  wire.Frame.finishFrameBuffer(builder, new wire.FrameT(kind, payload).pack(builder));
  return builder.asUint8Array();
}

export function encode(command: Command): Uint8Array {
  return encodePayload(payloadOf(command));
}

function payloadOf(command: Command): Payload {
  switch (command.kind) {
    case "takeHand":
      return [wire.Payload.TakeHand, new wire.TakeHandT()];
    case "giveHand":
      return [wire.Payload.GiveHand, new wire.GiveHandT()];
    case "grasp":
      return [wire.Payload.Grasp, new wire.GraspT(command.face, vec3(command.weights), command.push)];
    case "move":
      return [wire.Payload.Move, new wire.MoveT(vec3(command.to))];
    case "letGo":
      return [wire.Payload.LetGo, new wire.LetGoT()];
    case "reset":
      return [wire.Payload.Reset, new wire.ResetT()];
    case "undo":
      return [wire.Payload.Undo, new wire.UndoT()];
    case "pause":
      return [wire.Payload.Pause, new wire.PauseT(command.on)];
    case "step":
      return [wire.Payload.Step, new wire.StepT(command.ticks)];
    case "script":
      return [wire.Payload.Script, new wire.ScriptT(command.on)];
    case "setValue":
      return [wire.Payload.SetValue, new wire.SetValueT(command.key, command.value)];
    case "openScene":
      return [wire.Payload.OpenScene, new wire.OpenSceneT(command.file)];
    case "showField":
      return [wire.Payload.ShowField, new wire.ShowFieldT(command.field)];
    case "record":
      return [wire.Payload.Record, new wire.RecordT(command.on)];
    case "compare":
      return [wire.Payload.Compare, new wire.CompareT(command.on)];
    case "feel":
      return [wire.Payload.Feel, new wire.FeelT(command.presented)];
    case "answer":
      return [wire.Payload.Answer, new wire.AnswerT(command.same)];
    case "seek":
      return [wire.Payload.Seek, new wire.SeekT(command.time)];
    case "play":
      return [wire.Payload.Play, new wire.PlayT(command.on, command.speed)];
    case "ping":
      return [wire.Payload.Ping, new wire.PingT(BigInt(command.number))];
  }
}
