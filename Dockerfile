# uav_landing on Debian 12: see docs/container.md. scripts/test_container runs these steps without a container engine, and
# knows only the instructions and forms used here.
FROM debian:12 AS build
ENV LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive
WORKDIR /src
# Packages first: a change of the code does not install them again.
COPY scripts/setup scripts/usage.bash scripts/
RUN scripts/setup
COPY . .
# catkin takes the prefix for setup.bash when it configures, not from cmake --install --prefix.
RUN scripts/build && cmake -DCMAKE_INSTALL_PREFIX=/opt/uav_landing build && cmake --install build

# What flies: no compiler, no headers, no sources.
FROM debian:12-slim AS runtime
ENV LANG=C.UTF-8
COPY scripts/setup scripts/usage.bash /tmp/scripts/
RUN /tmp/scripts/setup --runtime && rm -r /tmp/scripts /var/lib/apt/lists && mkdir /var/lib/apt/lists
# Cameras are often readable for the group video only.
RUN useradd --create-home --groups video landing
COPY --from=build /opt/uav_landing /opt/uav_landing
COPY container/entry /usr/local/bin/entry
USER landing
WORKDIR /home/landing
ENTRYPOINT ["/usr/local/bin/entry"]
