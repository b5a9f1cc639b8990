# docker build -t stridescope .
# docker run --rm -p 8080:8080 -e STRIDESCOPE_TOKEN=a-long-secret stridescope
FROM python:3.12-slim

ENV PYTHONUNBUFFERED=1 PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1
RUN useradd --create-home walker
WORKDIR /home/walker/stridescope

# The lock first: it changes less often than the code, so its layer is kept.
COPY requirements-run.txt ./
RUN pip install --require-hashes --only-binary :all: --requirement requirements-run.txt

# Editable, so that assets/ and recordings/ are found beside app/.
COPY pyproject.toml README.md LICENSE ./
COPY app app
COPY assets assets
COPY recordings recordings
RUN pip install --no-deps --no-build-isolation --editable . && chown walker recordings

# Compiled here, so that the first walk need not wait for it.
USER walker
RUN python -c "from app.warm import warm_up; warm_up('kalman')"

EXPOSE 8080
HEALTHCHECK --interval=10s --timeout=3s --start-period=30s \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8080/healthz', timeout=2)"]

# Beyond loopback there is always a token: STRIDESCOPE_TOKEN, or one that is made and printed.
CMD ["stridescope", "walk", "--host", "0.0.0.0", "--port", "8080", "--no-open"]
