// A picture that pointers, the wheel and keys move and zoom. What extends it has ``moved``, which shows the picture
// where its view is, ``fit``, ``click``, and ``room``, how large it is on the screen.
class Movable {
  constructor(least, most) {
    this.view = { x: 0, y: 0, k: 1 };
    this.limits = [least, most];
  }

  zoom(factor, x = this.room.width / 2, y = this.room.height / 2) {
    const [least, most] = this.limits;
    const { view } = this;
    const k = Math.min(most, Math.max(least, view.k * factor));
    this.view = { k, x: x - ((x - view.x) * k) / view.k, y: y - ((y - view.y) * k) / view.k };
    this.moved();
  }

  shift(dx, dy) {
    this.view.x += dx;
    this.view.y += dy;
    this.moved();
  }

  listen(surface) {
    const pointers = new Map();
    let moved = 0;
    const spot = (event) => {
      const { left, top } = surface.getBoundingClientRect();
      return [event.clientX - left, event.clientY - top];
    };
    surface.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      pointers.set(event.pointerId, spot(event));
      moved = 0;
    });
    surface.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const now = spot(event);
      const others = [...pointers].filter(([id]) => id !== event.pointerId).map(([, point]) => point);
      moved += Math.hypot(now[0] - before[0], now[1] - before[1]);
      if (moved > 4) surface.setPointerCapture(event.pointerId);
      if (others.length) {
        const far = (point) => Math.hypot(point[0] - others[0][0], point[1] - others[0][1]);
        if (far(before)) this.zoom(far(now) / far(before), others[0][0], others[0][1]);
      } else this.shift(now[0] - before[0], now[1] - before[1]);
      pointers.set(event.pointerId, now);
    });
    const end = (event) => {
      if (pointers.delete(event.pointerId) && event.type === "pointerup" && moved <= 4) this.click(event.target, ...spot(event));
    };
    surface.addEventListener("pointerup", end);
    surface.addEventListener("pointercancel", end);
    surface.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.03 : 0.0015)), ...spot(event));
    }, { passive: false });
    surface.addEventListener("keydown", (event) => {
      const moves = { ArrowUp: [0, 60], ArrowDown: [0, -60], ArrowLeft: [60, 0], ArrowRight: [-60, 0] };
      if (event.shiftKey && moves[event.key]) this.shift(...moves[event.key]);
      else if (event.key === "+" || event.key === "=") this.zoom(1.25);
      else if (event.key === "-") this.zoom(0.8);
      else if (event.key === "0") this.fit(true);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }
}
