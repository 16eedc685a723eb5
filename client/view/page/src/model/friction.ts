// The friction ratio of fingers: what a surface holds them by along itself, over what it holds them by across.
import { Vector3 } from 'three';
import { ConstraintState } from '../gen/haptic/v1/telemetry_pb';
import type { FingerSpan } from '../scene/fingers';
import type { SceneObjects } from '../scene/objects';
import type { Moment } from './moment';

const NO_FORCE = 1e-4; // N across the surface; below, there is no ratio
const MOST_CONTACTS = 256; // that are looked at in one moment

const proxy = new Vector3();
const force = new Vector3();
const normal = new Vector3();

/**
 * Of each finger, the sum of |F_t| over the sum of |F_n| of its HIPs that a surface holds; NaN where none does. The
 * normal is that of the object's surface nearest to the proxy, with the object where it is drawn.
 */
export function frictionRatios(moment: Moment, fingers: FingerSpan[], objects: SceneObjects): number[] {
  const { hips } = moment;
  const across = new Array<number>(fingers.length).fill(0);
  const along = new Array<number>(fingers.length).fill(0);
  const count = Math.min(hips?.contactHip.length ?? 0, MOST_CONTACTS);
  for (let c = 0; c < count && hips; ++c) {
    const state = hips.contactState[c];
    if (state === ConstraintState.OUT || state === ConstraintState.TET) continue;
    force.fromArray(hips.contactForce, 3 * c);
    if (!(force.lengthSq() > 0)) continue;
    const hip = hips.contactHip[c] as number;
    const finger = fingers.findIndex(({ firstHip, hips: size }) => hip >= firstHip && hip < firstHip + size);
    proxy.fromArray(hips.contactProxy, 3 * c);
    if (finger < 0 || !objects.normalAt(hips.contactObject[c] as number, proxy, normal)) continue;
    const through = force.dot(normal);
    across[finger] = (across[finger] as number) + Math.abs(through);
    along[finger] = (along[finger] as number) + force.addScaledVector(normal, -through).length();
  }
  return across.map((n, i) => (n > NO_FORCE ? (along[i] as number) / n : Number.NaN));
}
