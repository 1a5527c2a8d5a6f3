# One image with the programs and the tools; which one runs is the service's command
# (docker-compose.yml).
FROM debian:bookworm-slim AS build
WORKDIR /abut
# The list alone first: it changes seldom, and the installed packages stay in the layer cache.
COPY scripts scripts
RUN scripts/install_dependencies.sh build image
COPY . .
# Without optional libraries: what the image holds may be passed on under the BSD licence.
RUN make build && DESTDIR=/image cmake --install build/release --prefix /usr/local \
  --component programs --strip

FROM debian:bookworm-slim
COPY scripts /tmp/scripts
RUN /tmp/scripts/install_dependencies.sh runtime && rm -rf /tmp/scripts /var/lib/apt/lists/*
COPY --from=build /image/usr/local /usr/local
# Not root; /abut/runs is where a run may write, /abut/keys where docker-compose.yml keeps keys.
RUN useradd --system --uid 10001 --no-create-home abut \
  && install -d -o abut -g abut /abut/runs && install -d -o abut -g abut -m 700 /abut/keys \
  && ln -s /usr/local/share/abut/configs /usr/local/share/abut/studies /abut/
# For bodies in Python, which a cluster starts without abut.
ENV PYTHONPATH=/usr/local/share/abut/python
USER abut
WORKDIR /abut
ENTRYPOINT ["abut"]
CMD ["--help"]
