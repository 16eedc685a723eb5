// A virtual device on its way to where the pointer wants it.

export type Point = [number, number, number];

/** m/s: well below the speed beyond which the daemon cuts force (safety.max_speed, 2 m/s unless told otherwise). */
export const TRAVEL_SPEED = 0.5;

/** Where `from` is after `seconds` on its way to `to`, no faster than TRAVEL_SPEED. m, world frame. */
export function travel(from: Point, to: Point, seconds: number): Point {
  const way: Point = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
  const distance = Math.hypot(...way);
  const reach = TRAVEL_SPEED * seconds;
  if (distance <= reach) return [...to];
  const share = reach / distance;
  return [from[0] + share * way[0], from[1] + share * way[1], from[2] + share * way[2]];
}
