# The image of a released archive, which scripts/release makes in target/release-archive:
# docker build -t corniche .
# docker run --rm --read-only -u "$(id -u):$(id -g)" -v "$PWD:/data" corniche build --dem dem.tif --osm roads.osm.pbf -o map.pmtiles
#
# It converts, measures, verifies, exports and serves. `--target draw` has a graphics driver, too, which draws by the processor.

FROM docker.io/library/debian:bookworm-slim AS root
RUN apt-get update \
    && apt-get install -y --no-install-recommends ca-certificates libstdc++6 zstd \
    && rm -rf /var/lib/apt/lists/*
COPY target/release-archive/*-x86_64-linux.tar.zst /archive/
COPY scripts/lib/image-root.sh /
RUN sh /image-root.sh /archive/*.tar.zst /image

FROM docker.io/library/debian:bookworm-slim AS draw
RUN apt-get update \
    && apt-get install -y --no-install-recommends ca-certificates libstdc++6 libvulkan1 mesa-vulkan-drivers \
    && rm -rf /var/lib/apt/lists/*
COPY --from=root /image/opt /opt
COPY --from=root --chown=1000:1000 /image/data /data
ENV PATH=/opt/corniche/bin:$PATH TMPDIR=/data XDG_RUNTIME_DIR=/tmp
USER 1000:1000
WORKDIR /data
ENTRYPOINT ["/opt/corniche/bin/corniche"]
CMD ["--help"]

FROM scratch AS convert
COPY --from=root /image /
# Where it keeps what does not fit into memory: the root need not be writable.
ENV PATH=/bin TMPDIR=/data
USER 1000:1000
WORKDIR /data
ENTRYPOINT ["/bin/corniche"]
CMD ["--help"]
