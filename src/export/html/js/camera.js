// The camera: begins where the scene's observer is, and turns about what the observer looks at.

// The width/height for which scenes are composed; narrower pictures show as much at the sides.
const WIDE = 16 / 9;
const NEAR = 0.01;
const STEEPEST = 0.5 * Math.PI - 0.01;

class Camera {
  constructor(observer, centre) {
    const direction = unit(observer.direction);
    this.fieldOfView = (observer.fieldOfView * Math.PI) / 180;
    const ahead = dot(subtract(centre, observer.position), direction);
    const distance = Math.max(ahead, 0.5);
    this.start = {
      pivot: add(observer.position, scale(direction, distance)),
      distance,
      yaw: Math.atan2(direction[0], -direction[2]),
      pitch: Math.asin(Math.max(-1, Math.min(1, direction[1]))),
    };
    this.reset();
  }

  reset() {
    Object.assign(this, this.start);
  }

  // True if it is not where it began.
  get hasMoved() {
    return Object.keys(this.start).some((name) => this[name] !== this.start[name]);
  }

  get direction() {
    const level = Math.cos(this.pitch);
    return [Math.sin(this.yaw) * level, Math.sin(this.pitch), -Math.cos(this.yaw) * level];
  }

  get position() {
    return subtract(this.pivot, scale(this.direction, this.distance));
  }

  get axes() {
    const backward = scale(this.direction, -1);
    const right = unit(cross([0, 1, 0], backward));
    return { right, up: cross(backward, right), backward };
  }

  turn(yaw, pitch) {
    this.yaw -= yaw;
    this.pitch = Math.max(-STEEPEST, Math.min(STEEPEST, this.pitch - pitch));
  }

  zoom(factor) {
    this.distance = Math.max(0.05, Math.min(500, this.distance * factor));
  }

  // Moves by parts of the height of the picture.
  move(x, y) {
    const { right, up } = this.axes;
    const size = 2 * this.distance * Math.tan(0.5 * this.fieldOfView);
    this.pivot = add(this.pivot, add(scale(right, -x * size), scale(up, y * size)));
  }

  // Half the height of the picture at distance 1.
  slope(aspect, fits) {
    const slope = Math.tan(0.5 * this.fieldOfView);
    return fits && aspect < WIDE ? (slope * WIDE) / aspect : slope;
  }

  // From the room to clip space: depth 1 at NEAR, 0 infinitely far.
  clipFromRoom(aspect, fits) {
    const { right, up, backward } = this.axes;
    const at = this.position;
    const view = [
      right[0], up[0], backward[0], 0,
      right[1], up[1], backward[1], 0,
      right[2], up[2], backward[2], 0,
      -dot(right, at), -dot(up, at), -dot(backward, at), 1,
    ];
    const f = 1 / this.slope(aspect, fits);
    return multiply([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, 0, -1, 0, 0, NEAR, 0], view);
  }

  // The direction through a point of the picture, from (−1, −1) to (1, 1).
  ray(x, y, aspect, fits) {
    const { right, up } = this.axes;
    const slope = this.slope(aspect, fits);
    return unit(add(this.direction, add(scale(right, x * slope * aspect), scale(up, y * slope))));
  }
}

