# One image for every node; the compose file says which one a container runs.
ARG BASE_IMAGE=python:3.11.14-slim-bookworm

FROM ${BASE_IMAGE} AS build
RUN python3 -m venv /opt/venv
ENV PATH=/opt/venv/bin:$PATH
WORKDIR /app
# `make wheels` fills build/wheels; then nothing is fetched here. An empty one means the package index.
COPY requirements.image.lock build/wheel[s] /wheels/
# What runs, not what tests.
RUN if ls /wheels/*.whl >/dev/null 2>&1; then offline="--no-index --find-links /wheels"; fi \
    && pip install --no-cache-dir $offline -r /wheels/requirements.image.lock \
    && find /opt/venv -type d -name tests -path '*/site-packages/*' -prune -exec rm -rf {} +
COPY pyproject.toml README.m[d] ./
COPY common common
COPY config config
COPY cli cli
COPY evaluation evaluation
COPY judge judge
COPY services services
COPY docs/audio docs/audio
RUN pip install --no-cache-dir --no-deps --no-build-isolation -e . && python -m compileall -q /app \
    && python -m common.speech_weights && python -m services.speech.prepared \
    && pip uninstall --quiet --yes hatchling pip

FROM ${BASE_IMAGE}
# libegl1 libgl1-mesa-dri give the cameras OpenGL; without them they use ray casting. "" leaves them out.
ARG APT_PACKAGES="libegl1 libgl1-mesa-dri"
RUN if [ -n "$APT_PACKAGES" ]; then \
        apt-get update && apt-get install -y --no-install-recommends $APT_PACKAGES && rm -rf /var/lib/apt/lists/*; \
    fi \
    && useradd --system --uid 10001 --create-home tidybot && mkdir -p /data && chown tidybot /data
COPY --from=build /opt/venv /opt/venv
COPY --from=build /app /app
WORKDIR /app
# Nothing outside /data and /tmp is written, so that the rest may be read-only.
ENV PYTHONUNBUFFERED=1 PYTHONDONTWRITEBYTECODE=1 OMP_NUM_THREADS=1 PATH=/opt/venv/bin:$PATH PYTHONPATH=/app HOME=/tmp
USER tidybot
VOLUME /data
CMD ["python", "-m", "services.router", "--listen", "tls/0.0.0.0:7447"]
