# Shared by run-tests and run-demo: where things are, what has to be installed, and how a step runs.
# To be sourced by bash with the working directory at the root of the project.

logs=build/logs
mkdir -p "$logs"

# ccache, if there is one, makes the second build of everything fast, and of whatever another build
# directory has compiled with the same options.
if command -v ccache >/dev/null; then
  export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD} CCACHE_NOHASHDIR=1
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

# Other programs that read and write our files, for the tests: a Python of their own in build/python,
# which tests find through HEXHEX_PYTHON. Without a network, the tests that need them are skipped.
install_python_programs() {
  if [[ -n "${HEXHEX_PYTHON:-}" ]]; then return 0; fi
  local python=$PWD/build/python wanted=tests/io/requirements.txt
  if ! cmp -s "$wanted" "$python/installed.txt"; then
    say "Installing meshio, gmsh, h5py, vtk, solvers and pytetwild from PyPI ..."
    if ! { rm -rf "$python" && python3 -m venv "$python" &&
           "$python/bin/pip" install --quiet --disable-pip-version-check -r "$wanted" &&
           cp "$wanted" "$python/installed.txt"; } >"$logs/python.log" 2>&1; then
      say "They could not be installed, and tests with them are skipped; see $logs/python.log."
      return 0
    fi
  fi
  export HEXHEX_PYTHON=$python/bin/python
}

# HiGHS, which finds integers when maps are quantized, in build/highs: builds remember where it is.
install_highs() {
  local folder=$PWD/build/highs version=1.15.1
  if [[ ! -f $folder/$version ]]; then
    say "Installing HiGHS from PyPI ..."
    if ! { rm -rf "$folder" && python3 -m venv "$folder" &&
           "$folder/bin/pip" install --quiet --disable-pip-version-check "highsbox==$version" &&
           touch "$folder/$version"; } >"$logs/highs.log" 2>&1; then
      say "It could not be installed, and integers are found by rounding; see $logs/highs.log."
      return 0
    fi
  fi
  highs_library=$("$folder/bin/python" -c 'import highsbox; print(highsbox.highs_dist_dir())')/lib/libhighs.so
}

# Optional parts: .vtkhdf, .cgns, repair, HiGHS. Without them these are left out.
optional_packages=(libhdf5-dev libeigen3-dev libdeflate0 liblz4-1 python3-venv)
# ... and what only tests need, which skip without it: VTK reads curved meshes. ParaView's Python has
# VTK, too, and Debian has either of them installed.
vtk_packages=(python3-vtk9)
# ... and solvers that docs/user/solvers has pages of.
solver_packages=(calculix-ccx python3-getfem python3-dolfinx python3-gmsh)
# What builds the ParaView plugin (its CMake files look for the three libraries), and what tests it:
# Debian's ParaView draws with X only.
paraview_packages=(paraview-dev python3-paraview libopenmpi-dev liblz4-dev libdouble-conversion-dev
  xvfb xauth)

# Meshes in parts on MPI, and parallel HDF5 to read them; any other MPI will do, too.
mpi_packages=(openmpi-bin libopenmpi-dev libhdf5-openmpi-dev)
# Libraries that cut meshes, and programs that judge parts; what is missing is not asked.
parts_packages=(libmetis5 libscotch-7.0 openfoam petsc-dev libexodusii-dev libdeal.ii-dev)

# What compiles for WebAssembly: a compiler of its own, about a gigabyte with what it brings.
wasm_packages=(emscripten libfast-float-dev libfmt-dev nlohmann-json3-dev libeigen3-dev)

# Other compilers and libraries that have to take the code.
libcxx_packages=(clang-19 libc++-19-dev libc++abi-19-dev)
mingw_packages=(g++-mingw-w64-x86-64-posix wine)

# The same for packages that can be done without.
install_optional() {
  install_missing "$@" || say "Without $*, what needs them is left out."
}

# Whether these packages are installed or can be. Fresh machines have no package lists yet.
can_install() {
  local try=(apt-get install --simulate --no-install-recommends "$@")
  has_packages "$@" && return 0
  command -v apt-get >/dev/null || return 1
  "${try[@]}" >/dev/null 2>&1 && return 0
  local as_root=()
  if ((EUID != 0)); then as_root=(sudo); fi
  "${as_root[@]}" apt-get update >"$logs/install.log" 2>&1 && "${try[@]}" >/dev/null 2>&1
}

# What `hexhex view` takes beside the packages of the command. Some machines have npm from elsewhere.
viewer_packages() {
  printf '%s\n' zlib1g-dev
  if ! command -v npm >/dev/null; then printf '%s\n' nodejs npm; fi
}

# Whether all of these Debian packages are installed.
has_packages() {
  local package
  for package in "$@"; do
    [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" == installed ]] || return 1
  done
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

# configure PRESET [cmake argument...]: a new build compiles ten files as one, in a third of the time. Who
# edits may prefer `cmake --preset PRESET -DCMAKE_UNITY_BUILD=OFF`, which stays as it is chosen.
configure() {
  local unity=()
  if [[ ! -f build/$1/CMakeCache.txt ]]; then unity=(-DCMAKE_UNITY_BUILD=ON); fi
  local highs=()
  if [[ -n "${highs_library:-}" ]]; then highs=("-DHIGHS_LIBRARY=$highs_library"); fi
  run_logged "$1-configure" cmake --preset "$1" "${unity[@]}" "${highs[@]}" "${@:2}"
}

# configure_release PART [cmake argument...]: the release build, at least with PART (COMMAND or
# BENCH). What takes more packages stays off, unless an earlier run of run-tests has switched it on.
configure_release() {
  local options=("${@:2}")
  if [[ ! -f build/release/CMakeCache.txt ]]; then
    options+=(-DHEXHEX_BUILD_TESTS=OFF -DHEXHEX_BUILD_BENCH=OFF)
  fi
  configure release "${options[@]}" "-DHEXHEX_BUILD_$1=ON"
}

# build PRESET [cmake --build argument...]
build() { run_logged "$1-build" cmake --build --preset "$@"; }

# Whether the release build has the viewer page.
has_viewer() { grep -q '^HEXHEX_HAS_VIEWER:INTERNAL=ON' build/release/CMakeCache.txt; }
