// Camera images with the measured and the predicted outline, or with features and their predicted displacements.
const FEATURE = 7;  // radius in the canvas's pixels

// The outlines or features of a picture: measured points, and ends of predicted lines.
function outlineTable(outline) {
  const { measured, predicted } = outline || { measured: [], predicted: [] };
  const column = (name, values, k, step) => ({ name: name + " [pixel]", values: Array.from(values).filter((x, i) => i % step === k).map((x) => 0.1 * x) });
  return [column("measured u", measured, 0, 2), column("measured v", measured, 1, 2),
    ...["u from", "v from", "u to", "v to"].map((name, k) => column("predicted " + name, predicted, k, 4))];
}

function startPicture() {
  const canvas = $("picture");
  if (!canvas) return;
  const cameras = new Map();  // by entry of the model file's observations
  for (const p of showing.pictures) {
    const image = new Image();
    image.onload = () => player.tell();
    image.src = p.jpeg;
    cameras.set(p.source, [...(cameras.get(p.source) || []), { time: p.time, image }]);
  }
  const sources = [...cameras.keys()].sort((a, b) => a - b);
  let source = sources[0];
  const choice = $("camera");
  if (choice) {
    sources.forEach((s, i) => choice.append(element("option", { value: s }, "camera " + (i + 1))));
    choice.onchange = () => {
      source = Number(choice.value);
      player.tell();
    };
  }
  const context = canvas.getContext("2d");
  const stroke = (style, width) => {
    context.strokeStyle = style;
    context.lineWidth = width;
    context.stroke();
  };
  const shown = (time) => {
    const pictures = cameras.get(source), picture = pictures[nearest(pictures.map((p) => p.time), time)];
    const outline = player.replay.outlines.find((o) => o.source === source && Math.abs(o.time - picture.time) < 1e-6);
    return { image: picture.image, outline };
  };
  $("picture-saves").append(saveButtons("camera image", () => outlineTable(shown(player.time).outline), () => savePicture("camera image", canvas, "")));
  const draw = (time) => {
    const { image, outline } = shown(time);
    if (!image.complete || !image.naturalWidth) return;
    canvas.width = 2 * image.naturalWidth;
    canvas.height = 2 * image.naturalHeight;
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    if (!outline) return;
    const scale = (0.1 * canvas.width) / outline.width, half = (0.5 * canvas.width) / outline.width;
    const p = outline.predicted, m = outline.measured;
    context.lineJoin = context.lineCap = "round";
    context.beginPath();
    for (let i = 0; i + 1 < m.length; i += 2) {
      const u = scale * m[i] + half, v = scale * m[i + 1] + half;
      if (!outline.joined) context.moveTo(u + FEATURE, v);
      if (outline.joined) context.lineTo(u, v);
      else context.arc(u, v, FEATURE, 0, 2 * Math.PI);
    }
    if (outline.closed) context.closePath();
    stroke(colour("measured-on-image"), outline.joined ? 5 : 3);
    context.beginPath();
    for (let i = 0; i + 3 < p.length; i += 4) {
      context.moveTo(scale * p[i] + half, scale * p[i + 1] + half);
      context.lineTo(scale * p[i + 2] + half, scale * p[i + 3] + half);
    }
    stroke(colour("predicted-on-image"), 2);
  };
  player.listen(draw);
}
