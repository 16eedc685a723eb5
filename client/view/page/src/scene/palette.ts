// Colours of what is drawn, the same in light and dark: chosen to be told apart by the colour-blind, too (Okabe, Ito).
import { Color } from 'three';
import { ConstraintState } from '../gen/haptic/v1/telemetry_pb';

export const STATE_COLOURS: Record<ConstraintState, string> = {
  [ConstraintState.TET]: '#cc79a7',
  [ConstraintState.SUR]: '#3a9bdc',
  [ConstraintState.EDG]: '#2fae82',
  [ConstraintState.VER]: '#e6c229',
  [ConstraintState.OUT]: '#8b929b',
};

export const STICKING_COLOUR = '#2fae82';
export const SLIPPING_COLOUR = '#f07f2e';

/** Of curves, devices and fingers, by their index. */
export const SERIES_COLOURS = ['#3a9bdc', '#f07f2e', '#2fae82', '#cc79a7', '#b59b00', '#7f7fff', '#d64550', '#5aa0a0'] as const;

export function seriesColour(index: number): string {
  return SERIES_COLOURS[index % SERIES_COLOURS.length] as string;
}

const MATERIAL_COLOURS = ['#9db8cf', '#c9a26b', '#a7c58b', '#c48f9f', '#8fa3d6', '#d2b48c', '#7fb7b2', '#b7a0cf'];

export function materialColour(index: number): string {
  return index < 0 ? '#9aa3ad' : (MATERIAL_COLOURS[index % MATERIAL_COLOURS.length] as string);
}

export const FORCE_COLOUR = '#e0434b';
export const DEVICE_FORCE_COLOUR = '#ff8f6b';
export const OBJECT_FORCE_COLOUR = '#9b6bdf';
export const SPRING_COLOUR = '#f2b134';

export const stateColours: readonly Color[] = [0, 1, 2, 3, 4].map((state) => new Color(STATE_COLOURS[state as ConstraintState]));
export const stickingColour = new Color(STICKING_COLOUR);
export const slippingColour = new Color(SLIPPING_COLOUR);
