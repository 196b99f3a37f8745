# Sourced by app/run and tests/run: what both need before they differ.
#   install_missing      installs those of app/packages that are missing
#   build PRESET TARGET  configures if necessary, and builds

cd "$(dirname "${BASH_SOURCE[0]}")/.."

install_missing() {
    local wanted installed missing=() package
    wanted=$(sed 's/#.*//' app/packages)
    installed=" $(dpkg-query -W -f '${db:Status-Abbrev}${Package} ' 2>/dev/null) "
    for package in $wanted; do
        [[ $installed == *"ii $package "* ]] || missing+=("$package")
    done
    [[ ${#missing[@]} -gt 0 ]] || return 0

    local as_root=()
    if [[ $(id -u) -ne 0 ]]; then
        # Ask for a password only where somebody can answer.
        if command -v sudo >/dev/null && { [[ -t 0 ]] || sudo -n true 2>/dev/null; }; then
            as_root=(sudo)
        else
            cannot_install "${missing[@]}"
        fi
    fi
    command -v apt-get >/dev/null || cannot_install "${missing[@]}"
    echo "Installing ${missing[*]}" >&2
    # Both write to stderr: stdout belongs to the program that runs afterwards.
    "${as_root[@]}" apt-get update -qq >&2 || echo "The package lists could not be updated; trying with those at hand." >&2
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2 ||
        cannot_install "${missing[@]}"
}

cannot_install() {
    {
        echo "These Debian packages are missing and could not be installed from here:"
        echo
        echo "    $*"
        echo
        echo "Install them as root, then start again:"
        echo
        echo "    apt-get install --no-install-recommends $*"
    } >&2
    exit 1
}

build() {
    local folder=.build/$1 log=.build/$1.log quiet=()
    mkdir -p .build
    if [[ ! -f $folder/build.ninja ]]; then
        echo "Configuring preset $1" >&2
        cmake --preset "$1" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
    fi
    # Progress is worth showing the first time; later a build is short, and often there is nothing to do.
    if [[ -f $folder/built-$2 ]]; then quiet=(-- --quiet); else echo "Building preset $1, some minutes the first time" >&2; fi
    cmake --build "$folder" --target "$2" "${quiet[@]}" >&2 || exit 1
    touch "$folder/built-$2"
}
