# docker build -t corniche .                          converts, measures, verifies and draws (by the processor)
# docker build -t corniche --target convert .         without the graphics driver: smaller, for servers and clusters
# docker run --rm -u "$(id -u):$(id -g)" -v "$PWD:/data" corniche build --dem dem.tif --osm roads.osm.pbf -o map.pmtiles

FROM docker.io/library/rust:1.95-slim-bookworm AS compile
RUN apt-get update \
    && apt-get install -y --no-install-recommends gcc libc6-dev libgdal-dev pkg-config \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /source
COPY . .
RUN cargo build --release --locked -p corniche-cli && strip target/release/corniche

FROM docker.io/library/debian:bookworm-slim AS convert
# Of geoid grids it has EGM96's alone. For others mount a folder: -v GRIDS:/grids -e PROJ_DATA=/usr/share/proj:/grids
RUN apt-get update \
    && apt-get install -y --no-install-recommends ca-certificates libgdal32 \
    && rm -rf /var/lib/apt/lists/*
COPY --from=compile /source/target/release/corniche /usr/local/bin/
RUN useradd --uid 1000 --create-home corniche && mkdir /data && chown corniche /data
USER corniche
WORKDIR /data
ENTRYPOINT ["corniche"]
CMD ["--help"]

FROM convert AS draw
USER root
RUN apt-get update \
    && apt-get install -y --no-install-recommends libvulkan1 mesa-vulkan-drivers \
    && rm -rf /var/lib/apt/lists/*
ENV XDG_RUNTIME_DIR=/tmp
USER corniche
