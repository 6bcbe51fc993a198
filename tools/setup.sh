# shellcheck shell=bash
# Sourced by ./run: brings a machine from nothing to an installed photograd.
#
# Three steps, each skipped when its result is there: system packages, the environment .venv, the two
# distributions. A step is remembered by the hash of what it was made from, in .venv/photograd-*.

# What the build needs | how to see that it is there | the Debian package that brings it.
system_needs() {
    cat <<'TABLE'
C++20 compiler     | command:g++                          | g++
CMake 3.25         | command:cmake                        | cmake
Ninja              | command:ninja                        | ninja-build
Embree 3 or 4      | header:embree[34]/rtcore.h           | libembree-dev
OpenVDB            | header:openvdb/openvdb.h             | libopenvdb-dev
GLM                | header:glm/glm.hpp                   | libglm-dev
Boost iostreams    | library:libboost_iostreams*[ob]      | libboost-iostreams-dev
zlib               | header:zlib.h                        | zlib1g-dev
Python's headers   | python:headers                       | python3-dev
Python's venv      | python:venv                          | python3-venv
TABLE
    if [ "$1" = all ]; then
        echo "Chromium           | command:chromium                     | chromium"
    fi
    if [ "$1" = dev ] || [ "$1" = all ]; then
        echo "doctest            | header:doctest/doctest.h             | doctest-dev"
        # Tests of the grader's isolation.
        echo "bubblewrap         | command:bwrap                        | bubblewrap"
        echo "libseccomp         | library:libseccomp.so*               | libseccomp2"
    fi
}

# The first interpreter that is new enough; PYTHON=... overrides.
find_python() {
    local candidate
    for candidate in "${PYTHON:-python3}" python3.14 python3.13 python3.12 python3.11; do
        if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            command -v "$candidate"
            return
        fi
    done
    return 1
}

# The versions of Python that pyproject.toml names, such as "3.11 3.12".
python_versions() { sed -n 's/.*Python :: \(3\.[0-9]\{1,\}\)".*/\1/p' pyproject.toml; }

# An interpreter of a version, with headers, from PATH or from pyenv; fails where there is none.
interpreter() {
    local candidate
    for candidate in "python$1" "${PYENV_ROOT:-$HOME/.pyenv}/versions/$1".*/bin/"python$1"; do
        if "$candidate" -c 'import ensurepip, pathlib, sys, sysconfig, venv
assert "%d.%d" % sys.version_info[:2] == sys.argv[1]
assert pathlib.Path(sysconfig.get_path("include"), "Python.h").exists()' "$1" 2>/dev/null; then
            command -v "$candidate"
            return
        fi
    done
    return 1
}

# True when a header or library lies where compilers look.
on_disk() {
    compgen -G "/usr/include/$1" || compgen -G "/usr/local/include/$1" ||
        compgen -G "/opt/homebrew/include/$1" || compgen -G "/usr/lib/$1" ||
        compgen -G "/usr/lib*/*/$1" || compgen -G "/usr/local/lib/$1" ||
        compgen -G "/opt/homebrew/lib/$1"
} >/dev/null

python_has() {
    local python
    python=$(find_python) || return 1
    case $1 in
        headers) "$python" -c 'import pathlib, sysconfig
assert pathlib.Path(sysconfig.get_path("include"), "Python.h").exists()' ;;
        venv) "$python" -c 'import ensurepip, venv' ;;
    esac
} 2>/dev/null

is_there() {
    case $1 in
        command:*) command -v "${1#*:}" >/dev/null ;;
        python:*) python_has "${1#*:}" ;;
        *) on_disk "${1#*:}" ;;
    esac
}

# Lines "what | package" of system_needs that are lacking.
missing_needs() {
    local what probe package
    while IFS='|' read -r what probe package; do
        is_there "${probe// /}" || echo "${what%"${what##*[! ]}"} |${package}"
    done < <(system_needs "$1")
}

# How this user may run apt-get: prints a prefix ("" for root), fails where there is no way.
apt_prefix() {
    command -v apt-get >/dev/null || return 1
    [ "$(id -u)" = 0 ] && return
    command -v sudo >/dev/null || return 1
    # Without a terminal sudo could not ask for a password.
    if sudo -n true 2>/dev/null || [ -t 0 ]; then echo sudo; else return 1; fi
}

# The packages of such lines, on one line.
packages_of() { cut -d '|' -f 2 <<<"$1" | tr -d ' ' | tr '\n' ' '; }

explain_missing() {
    local missing=$1 packages
    packages=$(packages_of "$missing")
    echo "photograd needs, and this machine lacks:"
    sed 's/ *|.*//; s/^/  - /' <<<"$missing"
    if command -v apt-get >/dev/null; then
        echo "Neither root nor sudo is at hand. Someone who has it runs:"
        echo "  apt-get update && apt-get install --no-install-recommends ${packages% }"
    else
        echo "Install them with the package manager of this system. On Debian 12 that would be:"
        echo "  apt-get install --no-install-recommends ${packages% }"
    fi
    echo "Then call ./run again."
    echo "A wheel built elsewhere (./run wheel) and laid into dist/ serves ./run demo without them."
} >&2

# Installs what is lacking; status 2, with the commands, where that is not possible.
ensure_system() {
    local missing packages prefix
    missing=$(missing_needs "$1")
    [ -n "$missing" ] || return 0
    if ! prefix=$(apt_prefix); then
        explain_missing "$missing"
        return 2
    fi
    packages=$(packages_of "$missing")
    say "system packages: installing ${packages}(up to 150 MB, a minute or two)"
    # shellcheck disable=SC2086  # the prefix may be empty, the packages are words
    logged system $prefix apt-get update -q || return
    # shellcheck disable=SC2086
    logged system $prefix env DEBIAN_FRONTEND=noninteractive \
        apt-get install -q -y --no-install-recommends $packages || return
    hash -r
    missing=$(missing_needs "$1")
    [ -z "$missing" ] || { say "installed, yet not found: $missing" && return 2; }
}

ensure_venv() {
    if .venv/bin/python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
        return
    fi
    say "environment: creating .venv with $(find_python)"
    rm -rf .venv
    logged environment "$(find_python)" -m venv .venv
}

hash_of() { find "$@" -type f ! -name '*.pyc' -print0 | sort -z | xargs -0 sha256sum | sha256sum; }

# Remembers that step $1 was made from what hashes to $2.
is_fresh() { [ "$(cat ".venv/photograd-$1" 2>/dev/null)" = "$2" ]; }
remember() { echo "$2" >".venv/photograd-$1"; }

# Installs groups of tools/requirements.py.
install_extra() {
    local lines
    mapfile -t lines < <(.venv/bin/python tools/requirements.py "$@")
    logged packages .venv/bin/python -m pip install -q "${lines[@]}"
}

# Python packages, then both distributions as editable installs. $1 is demo or dev.
ensure_packages() {
    local groups="build" key
    [ "$1" = dev ] && groups="build dev"
    key=$(hash_of pyproject.toml python/photograd_course/pyproject.toml python/dependencies.py \
        tools/setup.sh tools/requirements.py)
    is_fresh "packages-$1" "$key" && return
    say "Python packages: $groups requirements"
    # shellcheck disable=SC2086
    install_extra $groups
    rm -f .venv/photograd-core
    ensure_core with-dependencies
    remember "packages-$1" "$key"
    remember packages-demo "$key"  # dev includes it
}

# Compiles the core where its sources changed, and installs both distributions from this tree. One
# after the other, and without naming the place of the first: pip takes two for a conflict.
ensure_core() {
    local key options=(-q --no-build-isolation)
    [ "${1:-}" = with-dependencies ] || options+=(--no-deps)
    key="$(core_options) $(hash_of CMakeLists.txt cpp pyproject.toml)"
    is_fresh core "$key" && return
    say "core: compiling (first time nine minutes of processor time, then only what changed)"
    logged core .venv/bin/python -m pip install "${options[@]}" -e python/photograd_course
    PHOTOGRAD_RELEASE=1 SKBUILD_CMAKE_DEFINE=$(core_options) \
        logged core .venv/bin/python -m pip install "${options[@]}" -e .
    remember core "$key"
}

# Continuous integration treats warnings as errors; the C++ tests are built where doctest is there.
core_options() {
    local werror=OFF tests=OFF
    [ "${CI:-}" = true ] && werror=ON
    on_disk doctest/doctest.h && [ -e cpp/tests/main.cpp ] && tests=ON
    echo "PHOTOGRAD_WERROR=$werror;PHOTOGRAD_CPP_TESTS=$tests"
}

# Everything for `./run demo` (demo) or for tests and tools (dev).
ensure_installed() {
    mkdir -p build/log
    ensure_system "$1"
    ensure_venv
    ensure_packages "$1"
    ensure_core
}

# The way for who may not install libraries: a wheel that carries them.
ensure_wheel() {
    local wheel key tag
    python_has venv || return 1
    tag=$("$(find_python)" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
    wheel=$(compgen -G "dist/photograd-*-$tag-*.whl" | head -n 1) || return 1
    key=$(sha256sum dist/*.whl)
    mkdir -p build/log
    ensure_venv || return
    is_fresh wheel "$key" && return
    say "installing $wheel"
    logged wheel .venv/bin/python -m pip install -q --force-reinstall --find-links dist "$wheel" || return
    remember wheel "$key"
}

# Where the installed core was compiled.
build_folder() {
    .venv/bin/python -c 'import sys, sysconfig
tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
platform = sysconfig.get_platform().replace("-", "_")
print(f"build/{tag}-{tag}-{platform}")'
}
