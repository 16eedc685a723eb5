// What is drawn, in numbers: for the tests in a browser, and for the curious at its console (`hapticView.drawn()`).
import { Vector3 } from 'three';
import type { Player } from './model/player';
import type { SceneView } from './scene/view';
import type { Session } from './session';

export interface Drawn {
  tick: number | undefined;
  armed: boolean | undefined;
  objects: Record<string, [number, number, number]>; // m, world
  arrows: { hips: number[]; devices: number[]; objects: number[] }; // lengths, m
  arrowScale: number; // m/N
  forces: { hips: number[]; devices: number[] }; // magnitudes that the drawn moment tells, N; of those above 0
  triangles: number;
  pictures: number;
  received: number; // bytes
  lostFrames: number;
  moments: number;
}

function magnitudes(values: ArrayLike<number> | undefined): number[] {
  const all: number[] = [];
  for (let i = 0; i + 2 < (values?.length ?? 0); i += 3) {
    all.push(Math.hypot(values?.[i] as number, values?.[i + 1] as number, values?.[i + 2] as number));
  }
  return all.filter((magnitude) => magnitude > 1e-6);
}

export function inspectable(view: SceneView, session: Session, player: () => Player) {
  return {
    /** Where on the page a point of the world is seen, in pixels. */
    project(x: number, y: number, z: number): { x: number; y: number } {
      const box = view.stage.renderer.domElement.getBoundingClientRect();
      view.stage.camera.updateMatrixWorld();
      const at = new Vector3(x, y, z).project(view.stage.camera);
      return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
    },
    /** Where fingers are drawn, m, world; only those whose device is present. */
    fingers(): Record<string, [number, number, number]> {
      const shown = (view.bodies?.bodies ?? []).filter(({ mesh }) => mesh.visible);
      return Object.fromEntries(shown.map(({ name, mesh }) => [name, mesh.position.toArray()]));
    },
    drawn(): Drawn {
      const moment = view.current;
      return {
        tick: moment?.tick,
        armed: moment?.armed,
        objects: Object.fromEntries(
          (view.objects?.items ?? []).map((item) => [item.name, item.frame.getWorldPosition(new Vector3()).toArray()]),
        ),
        arrows: {
          hips: view.hipForces.lengths(),
          devices: view.deviceForces.lengths(),
          objects: view.objectForces.lengths(),
        },
        arrowScale: view.look.arrowScale,
        forces: { hips: magnitudes(moment?.hips?.force), devices: magnitudes(moment?.devices?.force) },
        triangles: view.triangles,
        pictures: view.stage.pictures,
        received: session.client.received,
        lostFrames: session.lostFrames,
        moments: player().source.moments.length,
      };
    },
  };
}
