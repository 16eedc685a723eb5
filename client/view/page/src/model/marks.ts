import { type Event, Event_Kind } from '../gen/haptic/v1/telemetry_pb';
import type { Mark } from './moment';
import { nameOfFault } from './words';

export function markOf(event: Event, time: number): Mark {
  switch (event.kind) {
    case Event_Kind.FAULT_LATCHED:
      return { time, kind: 'fault', text: event.fault ? nameOfFault(event.fault.kind) : event.message };
    case Event_Kind.ARMED:
    case Event_Kind.DISARMED:
      return { time, kind: 'arm', text: event.message };
    default:
      return { time, kind: 'note', text: event.message };
  }
}
