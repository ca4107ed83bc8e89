"use strict";
{
  const find = (id) => document.getElementById(id);
  const [frame, stack, over, under, edge, slider, zoom] =
    ["frame", "stack", "over", "under", "edge", "slider", "zoom"].map(find);
  const pictures = [...document.querySelectorAll("figure img")];

  const choose = (select, shown, first) => {
    for (const picture of pictures) select.add(new Option(picture.alt, picture.id, false, picture.id === first));
    const show = () => { shown.src = find(select.value).src; };
    select.addEventListener("change", show);
    show();
  };
  choose(find("left"), over, "picture0");
  choose(find("right"), under, "reference");

  const move = () => {
    const share = slider.value / 10;
    over.style.clipPath = `inset(0 ${100 - share}% 0 0)`;
    edge.style.left = `${share}%`;
  };
  slider.addEventListener("input", move);

  const follow = (event) => {
    const box = stack.getBoundingClientRect();
    slider.value = 1000 * (event.clientX - box.left) / box.width;
    move();
  };
  stack.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    stack.setPointerCapture(event.pointerId);
    follow(event);
  });
  stack.addEventListener("pointermove", (event) => {
    if (event.buttons) follow(event);
  });

  const resize = () => {
    const factor = Number(zoom.value);
    const width = find("reference").naturalWidth;
    frame.style.width = factor ? `${width * factor}px` : `min(100%, ${Math.max(width, 640)}px)`;
    frame.style.maxWidth = factor ? "none" : "100%";
    for (const picture of [over, under]) picture.style.imageRendering = factor > 1 ? "pixelated" : "auto";
  };
  zoom.addEventListener("change", resize);

  find("viewer").hidden = false;
  move();
  resize();
}
