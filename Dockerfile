# One image for every node; the compose file says which one a container runs.
ARG BASE_IMAGE=python:3.11-slim
FROM ${BASE_IMAGE}

# libegl1 libgl1-mesa-dri give the cameras OpenGL; without them they use ray casting. "" leaves them out.
ARG APT_PACKAGES="libegl1 libgl1-mesa-dri"
RUN if [ -n "$APT_PACKAGES" ]; then \
        apt-get update && apt-get install -y --no-install-recommends $APT_PACKAGES && rm -rf /var/lib/apt/lists/*; \
    fi

ENV PYTHONUNBUFFERED=1 OMP_NUM_THREADS=1 PATH=/opt/venv/bin:$PATH PYTHONPATH=/app
RUN python3 -m venv /opt/venv
WORKDIR /app

# `make wheels` fills build/wheels; then nothing is fetched here. An empty one means the package index.
COPY requirements.lock build/wheel[s] /wheels/
RUN if ls /wheels/*.whl >/dev/null 2>&1; then \
        pip install --no-cache-dir --no-index --find-links /wheels -r /wheels/requirements.lock; \
    else \
        pip install --no-cache-dir -r /wheels/requirements.lock; \
    fi && rm -rf /wheels

COPY common common
COPY config config
COPY cli cli
COPY evaluation evaluation
COPY services services
COPY docs/audio docs/audio
COPY pyproject.toml README.m[d] ./
RUN pip install --no-cache-dir --no-deps --no-build-isolation -e . \
    && useradd --system --uid 10001 --create-home tidybot && mkdir -p /data && chown tidybot /data
USER tidybot
VOLUME /data
CMD ["python", "-m", "services.router", "--listen", "tls/0.0.0.0:7447"]
