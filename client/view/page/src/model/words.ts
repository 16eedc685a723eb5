// What the schema's enums are called on the page, and what to do about a fault.
import { Role } from '../gen/haptic/v1/config_pb';
import { DevicePhase, type Fault, FaultKind, LimitKind } from '../gen/haptic/v1/device_pb';
import { ConstraintState } from '../gen/haptic/v1/telemetry_pb';

export const STATES: readonly ConstraintState[] = [
  ConstraintState.TET,
  ConstraintState.SUR,
  ConstraintState.EDG,
  ConstraintState.VER,
  ConstraintState.OUT,
];

const STATE_NAMES: Record<ConstraintState, string> = {
  [ConstraintState.TET]: 'Tet',
  [ConstraintState.SUR]: 'Sur',
  [ConstraintState.EDG]: 'Edg',
  [ConstraintState.VER]: 'Ver',
  [ConstraintState.OUT]: 'Out',
};

export function nameOfState(state: ConstraintState): string {
  return STATE_NAMES[state] ?? `state ${state}`;
}

const STATE_HELP: Record<ConstraintState, string> = {
  [ConstraintState.TET]: 'in the material of a cell',
  [ConstraintState.SUR]: 'held by a face',
  [ConstraintState.EDG]: 'held by an edge',
  [ConstraintState.VER]: 'held by a vertex',
  [ConstraintState.OUT]: 'held by nothing',
};

export function helpOfState(state: ConstraintState): string {
  return STATE_HELP[state] ?? '';
}

const PHASES: Record<DevicePhase, string> = {
  [DevicePhase.DEVICE_PHASE_UNSPECIFIED]: '',
  [DevicePhase.DEVICE_ABSENT]: 'absent',
  [DevicePhase.DEVICE_FOUND]: 'found',
  [DevicePhase.DEVICE_OPENING]: 'opening',
  [DevicePhase.DEVICE_HOMING]: 'home it',
  [DevicePhase.DEVICE_READY]: 'ready',
  [DevicePhase.DEVICE_ARMED]: 'armed',
  [DevicePhase.DEVICE_FAULT]: 'fault',
};

/** Where the device stands; of a daemon that does not tell its phase, as far as it can be known. */
export function nameOfPhase(phase: DevicePhase, present: boolean, armed: boolean, fault: FaultKind): string {
  if (phase !== DevicePhase.DEVICE_PHASE_UNSPECIFIED) return PHASES[phase] ?? `phase ${phase}`;
  if (fault !== FaultKind.FAULT_NONE) return 'fault';
  if (!present) return 'absent';
  return armed ? 'armed' : 'ready';
}

const LIMITS: [LimitKind, string][] = [
  [LimitKind.LIMIT_FORCE, 'force'],
  [LimitKind.LIMIT_RATE, 'rate'],
  [LimitKind.LIMIT_RAMP, 'soft start'],
  [LimitKind.LIMIT_MEAN_FORCE, 'warm motors'],
  [LimitKind.LIMIT_CLUTCH, 'clutch'],
];

/** Of DevicesFrame.limits: bit n is LimitKind n. */
export function namesOfLimits(bits: number): string[] {
  return LIMITS.filter(([kind]) => (bits & (1 << kind)) !== 0).map(([, name]) => name);
}

interface FaultWords {
  title: string;
  unit: string;
  todo: string;
}

const FAULTS: Record<FaultKind, FaultWords> = {
  [FaultKind.FAULT_NONE]: { title: 'no fault', unit: '', todo: '' },
  [FaultKind.FAULT_NOT_FINITE]: {
    title: 'A pose or a force was no number',
    unit: '',
    todo: 'Check the device and its calibration, then clear the fault.',
  },
  [FaultKind.FAULT_OVER_SPEED]: {
    title: 'The device moved too fast',
    unit: 'm/s',
    todo: 'Hold it still, clear the fault, and arm again.',
  },
  [FaultKind.FAULT_STALE_SAMPLE]: {
    title: 'No new sample came from the device',
    unit: 's',
    todo: 'Check its cable or the client that moves it; clear the fault when samples come again.',
  },
  [FaultKind.FAULT_MISSED_TICKS]: {
    title: 'The servo thread slept through ticks',
    unit: 'ticks',
    todo: 'See what loads the machine and whether the daemon has real-time rights, then clear the fault.',
  },
  [FaultKind.FAULT_LOST_DRIVER]: {
    title: 'Whoever held the drive lease is gone or silent',
    unit: 's',
    todo: 'See to the program that drove; clear the fault when the hands are safe.',
  },
  [FaultKind.FAULT_OVER_TRAVEL]: {
    title: 'The device was beyond its travel',
    unit: 'm',
    todo: 'Bring it back into its working space, then clear the fault.',
  },
  [FaultKind.FAULT_ENERGY]: {
    title: 'The device gave more energy than it may',
    unit: 'J',
    todo: 'Contact may be unstable: lower the stiffness, clear the fault, and arm again.',
  },
  [FaultKind.FAULT_LOST_DEVICE]: {
    title: 'The device is gone',
    unit: 's',
    todo: 'Plug it in or see to its power; clear the fault when it is ready.',
  },
  [FaultKind.FAULT_EMERGENCY_STOP]: {
    title: 'Emergency stop',
    unit: '',
    todo: 'When all is safe, clear the fault and arm again.',
  },
  [FaultKind.FAULT_STILL_SAMPLE]: {
    title: 'The device told the same position all the time',
    unit: 's',
    todo: 'Its electronics may hang: reconnect it, then clear the fault.',
  },
};

export function wordsOfFault(fault: Fault): { title: string; detail: string; todo: string } {
  const words = FAULTS[fault.kind] ?? { title: `Fault ${fault.kind}`, unit: '', todo: 'Clear it when all is safe.' };
  const parts = [fault.device && `device ${fault.device}`, `tick ${fault.tick}`];
  if (fault.limit > 0) {
    const unit = words.unit === '' ? '' : ` ${words.unit}`;
    parts.splice(1, 0, `${Number(fault.value.toPrecision(3))}${unit} where ${Number(fault.limit.toPrecision(3))}${unit} is allowed`);
  }
  return { title: words.title, detail: parts.filter(Boolean).join(' · '), todo: words.todo };
}

export function nameOfFault(kind: FaultKind): string {
  return kind === FaultKind.FAULT_NONE ? '' : (FAULTS[kind]?.title ?? `Fault ${kind}`);
}

const ROLES: Record<Role, string> = {
  [Role.ROLE_UNSPECIFIED]: 'observe',
  [Role.OBSERVE]: 'observe',
  [Role.SCRIPT]: 'script',
  [Role.DRIVE]: 'drive',
  [Role.ADMIN]: 'admin',
};

export function nameOfRole(role: Role): string {
  return ROLES[role] ?? 'observe';
}
