# Shared by run-tests and run-demo: where things are, what has to be installed, and how a step runs.
# To be sourced by bash with the working directory at the root of the project.

logs=build/logs
mkdir -p "$logs"

# ccache, if there is one, makes the second build of everything fast.
if command -v ccache >/dev/null; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi

say() { printf '%s\n' "$*"; }

# Installs the Debian packages among the arguments that are missing.
install_missing() {
  if ! command -v dpkg-query >/dev/null; then
    say "This is no Debian or Ubuntu. If the build fails, install what these packages hold: $*"
    return 0
  fi
  local missing=() package
  for package in "$@"; do
    if [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]]; then
      missing+=("$package")
    fi
  done
  if ((${#missing[@]} == 0)); then return 0; fi

  local as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      say "These packages are missing: ${missing[*]}"
      say "Installing them takes root. Run as root: apt-get install ${missing[*]}"
      return 1
    fi
    as_root=(sudo)
  fi
  say "Installing ${missing[*]} ..."
  local options=(-y --no-install-recommends)
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install "${options[@]}" \
      "${missing[@]}" >"$logs/install.log" 2>&1; then
    # Fresh machines have no package lists yet.
    if ! { "${as_root[@]}" apt-get update &&
           "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install "${options[@]}" \
             "${missing[@]}"; } >>"$logs/install.log" 2>&1; then
      tail -n 20 "$logs/install.log"
      say "The packages could not be installed; see $logs/install.log."
      return 1
    fi
  fi
}

# Libraries of optional parts: .vtkhdf, .cgns, .exo, repair. Without them these are left out.
optional_packages=(liblbfgs-dev libhdf5-dev libcgns-dev libexodusii-dev)

# The same for packages that can be done without.
install_optional() {
  install_missing "$@" || say "Without $*, what needs them is left out."
}

# run_logged NAME COMMAND...: runs a command quietly; shows the end of its output if it fails.
run_logged() {
  local log="$logs/$1.log"
  shift
  if "$@" >"$log" 2>&1; then return 0; fi
  # What compilers complain about is rarely at the end of a long log.
  if ! grep -E -A6 '(error|ERROR):|CMake Error' "$log" | head -n 60; then tail -n 25 "$log"; fi
  say "--- all of it: $log"
  return 1
}

# configure PRESET [cmake argument...]
configure() { run_logged "$1-configure" cmake --preset "$@"; }

# configure_release PART: the release build, at least with PART (COMMAND or BENCH). What takes more
# packages stays off, unless an earlier run of run-tests has switched it on.
configure_release() {
  local options=()
  if [[ ! -f build/release/CMakeCache.txt ]]; then
    options=(-DHEXHEX_BUILD_TESTS=OFF -DHEXHEX_BUILD_BENCH=OFF)
  fi
  configure release "${options[@]}" "-DHEXHEX_BUILD_$1=ON"
}

# build PRESET [cmake --build argument...]
build() { run_logged "$1-build" cmake --build --preset "$@"; }
