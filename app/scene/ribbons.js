// A ribbon is at least as broad as the line that it stands for, in pixels, from however far away it is seen.
(() => {
  const pixel = { value: 0 }; // what a pixel covers a metre away, metres
  const known = new WeakSet();
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
  const look = (object) => {
    const material = object.material;
    if (!material || known.has(material) || !object.geometry.attributes._side) return false;
    known.add(material);
    material.onBeforeCompile = widen;
    material.needsUpdate = true;
    return true;
  };
  setInterval(() => {
    const viewer = window.__viserMutable;
    if (!viewer || !viewer.camera || !viewer.canvas || document.hidden) return;
    pixel.value = (2 * Math.tan((viewer.camera.fov * Math.PI) / 360)) / Math.max(1, viewer.canvas.clientHeight);
    let changed = false;
    for (const [name, node] of Object.entries(viewer.nodeRefFromName))
      if (node && /^\/ned\/(trail\/.*\/piece_|outline\/)/.test(name))
        node.traverse((object) => { changed = look(object) || changed; });
    if (changed && viewer.requestRender) viewer.requestRender();
  }, 200);
})();
