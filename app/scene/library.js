// Edge, scene: uploads: the chosen file goes to the door as it is; what becomes of it is told beside it.
(() => {
  const most = 1e9;
  document.addEventListener("change", (event) => {
    const input = event.target;
    if (!(input instanceof HTMLInputElement) || !("ssUpload" in input.dataset) || !input.files.length) return;
    const file = input.files[0], box = input.closest(".ss-upload");
    const bar = box.querySelector("progress"), told = box.querySelector("[data-ss-told]");
    const tell = (text, bad) => {
      told.textContent = text; // text from files is never markup
      told.classList.toggle("ss-trouble", bad);
      bar.hidden = true;
      input.disabled = false;
      input.value = "";
    };
    if (file.size > most) return tell(`${file.name}: ${(file.size / 1e6).toFixed(0)} MB, expected at most 1000 MB`, true);
    const request = new XMLHttpRequest();
    request.open("POST", `/files?name=${encodeURIComponent(file.name)}`);
    request.setRequestHeader("Content-Type", "application/octet-stream");
    request.upload.onprogress = (sent) => { bar.value = sent.loaded / sent.total; };
    request.upload.onload = () => { told.textContent = `${file.name}: reading…`; };
    request.onload = () => tell(request.responseText.trim(), request.status !== 200);
    request.onerror = () => tell(`${file.name}: the connection broke, nothing was kept`, true);
    bar.value = 0;
    bar.hidden = false;
    input.disabled = true;
    told.textContent = `${file.name}: uploading…`;
    told.classList.remove("ss-trouble");
    request.send(file);
  });
})();
