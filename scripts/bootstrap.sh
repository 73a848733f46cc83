#!/bin/bash
# Installs the Debian packages that are missing, and nothing when none is.
#
#   scripts/bootstrap.sh build    what building and running the eyebox binary needs  (./demo)
#   scripts/bootstrap.sh check    that, and what the tests and the lint need         (./check)
#   scripts/bootstrap.sh list build|check    prints the packages, installs nothing
#
# Written for Debian 12. Needs root or sudo only where a package is missing. A package that the
# project comes to need is added to one of the two lists here and nowhere else.
set -euo pipefail

build_packages=(
  g++ cmake ninja-build pkg-config
  libabsl-dev libaravis-dev libceres-dev libcli11-dev libeigen3-dev libfmt-dev libgpiod-dev
  libgrpc++-dev libhdf5-dev libiio-dev
  libopencv-dev # its CMake package demands every module; the four that are used are not enough
  libpng-dev libprotobuf-dev libspdlog-dev libsqlitecpp-dev libssl-dev libtiff-dev libxxhash-dev
  libusb-1.0-0-dev # asked for by libaravis-dev's pkg-config file
  prometheus-cpp-dev protobuf-compiler protobuf-compiler-grpc
)
check_packages=(
  aravis-tools ccache clang clang-format clang-tidy git
  libbenchmark-dev libboost-dev libgmock-dev libgmp-dev libgtest-dev libmpfr-dev librapidcheck-dev
  python3 python3-grpcio python3-h5py python3-numpy python3-protobuf python3-scipy
  strace
)

fail() {
  echo "bootstrap: $1" >&2
  exit 1
}

packages_for() {
  case "${1:-}" in
    build) printf '%s\n' "${build_packages[@]}" ;;
    check) printf '%s\n' "${build_packages[@]}" "${check_packages[@]}" ;;
    *) fail "expected 'build' or 'check', got '${1:-}'; see the head of scripts/bootstrap.sh" ;;
  esac
}

# Prints those of the arguments that are not installed.
missing_of() {
  local installed
  installed=$(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
    sed -n 's/^installed //p' || true)
  comm -23 <(printf '%s\n' "$@" | sort -u) <(sort -u <<<"$installed")
}

install_packages() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "not root and no sudo; as root run: apt-get install --no-install-recommends $*"
    as_root=(sudo)
  fi
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y
    -o DPkg::Lock::Timeout=600 -o Dpkg::Use-Pty=0)
  echo "bootstrap: installing $*"
  "${apt[@]}" update || fail "apt-get update failed; are /etc/apt/sources.list and the network right?"
  "${apt[@]}" install --no-install-recommends "$@" || fail "apt-get could not install: $*"
}

main() {
  if [ "${1:-}" = list ]; then
    packages_for "${2:-}"
    return
  fi
  local wanted missing
  wanted=$(packages_for "${1:-}")
  command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
    fail "this is no Debian (no dpkg-query, no apt-get); install by hand what provides: ${wanted//$'\n'/ }"
  # shellcheck disable=SC2086  # one word per package
  missing=$(missing_of $wanted)
  # shellcheck disable=SC2086
  [ -z "$missing" ] || install_packages $missing
}

main "$@"
