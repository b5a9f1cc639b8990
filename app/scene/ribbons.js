// Edge, scene: a ribbon is at least as broad as the line that it stands for, in pixels, however far away.
(() => {
  const pixel = { value: 0 }; // what a pixel covers a metre away, metres
  let kinds = 0; // of material that know it
  const widen = (shader) => {
    shader.uniforms.ssPixel = pixel;
    shader.vertexShader = "attribute vec4 _side;\nuniform float ssPixel;\n" + shader.vertexShader.replace(
      "#include <project_vertex>",
      `float ssAway = -(modelViewMatrix * vec4(transformed, 1.0)).z;
      float ssPixels = MOST_PIXELS * _side.w;
      float ssHalf = 0.5 * (ssPixels - 1.0) * ssPixel * ssAway; // its edges are lines of a pixel
      transformed += _side.xyz * max(0.0, ssHalf - HALF_M * ssPixels);
      #include <project_vertex>`,
    );
  };
  // Set for the kinds of material, not for each: a ribbon drawn once without it would have its shader made twice.
  // What is no ribbon has no sides, and is drawn as before.
  const kind = (object) => Object.getPrototypeOf(object.material);
  const prepare = (viewer) => {
    const late = [];
    for (const [name, node] of Object.entries(viewer.nodeRefFromName))
      if (node && /^\/ned\/(trail\/.*\/piece_|outline\/)/.test(name))
        node.traverse((object) => {
          const sides = object.material && object.geometry.attributes._side;
          if (sides && kind(object).onBeforeCompile !== widen) late.push(object);
        });
    for (const object of late) object.material.needsUpdate = true;
    for (const what of new Set(late.map(kind))) {
      what.onBeforeCompile = widen;
      kinds += 1;
    }
    if (late.length && viewer.requestRender) viewer.requestRender();
  };
  setInterval(() => {
    const viewer = window.__viserMutable;
    if (!viewer || !viewer.camera || !viewer.canvas || document.hidden) return;
    pixel.value = (2 * Math.tan((viewer.camera.fov * Math.PI) / 360)) / Math.max(1, viewer.canvas.clientHeight);
    if (kinds < 2) prepare(viewer); // of the strips, of their edges
  }, 200);
})();
