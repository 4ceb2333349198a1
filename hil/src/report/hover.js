// One instant in all plots: a line under the pointer, its values, and the drone on the map.
(() => {
  const NS = "http://www.w3.org/2000/svg";
  const make = (svg, name, className) => {
    const node = document.createElementNS(NS, name);
    node.setAttribute("class", className);
    node.setAttribute("visibility", "hidden");
    return svg.appendChild(node);
  };
  const set = (node, values) => {
    for (const name in values) node.setAttribute(name, values[name]);
  };
  const numbers = (text) => text.split(" ").map(Number);

  const plots = [...document.querySelectorAll("svg.plot")].map((svg) => ({
    svg,
    x: numbers(svg.dataset.x),
    y: numbers(svg.dataset.y),
    area: numbers(svg.dataset.area),
    curves: [...svg.querySelectorAll("path[data-label]")].map((path) => ({
      label: path.dataset.label,
      points: path.getAttribute("d").split(/[ML]/).slice(1).map(numbers),
    })),
    line: make(svg, "path", "cursor s-ink"),
    text: make(svg, "text", "f-ink s-paper halo small"),
  }));
  const map = document.getElementById("map");
  const track = (map.dataset.track || "").split(",").map(numbers);
  const drone = make(map, "circle", "cursor f-homing s-paper");
  set(drone, { r: 6 });

  const nearest = (points, x) =>
    points.reduce((best, point) => (Math.abs(point[0] - x) < Math.abs(best[0] - x) ? point : best), points[0]);

  const show = (time) => {
    for (const { x, y, area, curves, line, text } of plots) {
      const [left, top, right, bottom] = area;
      const place = left + ((time - x[0]) / (x[1] - x[0])) * (right - left);
      const values = curves.filter((curve) => curve.points.length).map((curve) => {
        const value = y[1] - ((nearest(curve.points, place)[1] - top) / (bottom - top)) * (y[1] - y[0]);
        return `${curve.label} ${value.toPrecision(3)}`.trim();
      });
      const flip = place > (left + right) / 2;
      set(line, { d: `M${place} ${top}V${bottom}`, visibility: "visible" });
      set(text, { x: place + (flip ? -6 : 6), y: top + 10, "text-anchor": flip ? "end" : "start", visibility: "visible" });
      text.textContent = [`${time.toFixed(1)} s`, ...values].join(" · ");
    }
    const here = nearest(track, time);
    if (here.length === 3) set(drone, { cx: here[1], cy: here[2], visibility: "visible" });
  };
  const hide = () => {
    for (const node of document.querySelectorAll(".cursor, .cursor + text")) set(node, { visibility: "hidden" });
  };

  for (const { svg, x, area } of plots) {
    svg.addEventListener("pointermove", (event) => {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse()).x;
      if (at < area[0] || at > area[2]) return hide();
      show(x[0] + ((at - area[0]) / (area[2] - area[0])) * (x[1] - x[0]));
    });
    svg.addEventListener("pointerleave", hide);
  }
})();
