# shellcheck shell=bash
# Requirements of the scripts: missing ones are installed on Debian and Ubuntu, and listed on other
# systems. Sourced by the other scripts.
#
# LCM_DRY_RUN=1  prints the installation commands without running them.

say() {
    printf '%s\n' "$*" >&2
}

have() {
    command -v "$1" >/dev/null 2>&1
}

# True if the dynamic linker finds a library, or if there is no cache to ask (musl, macOS): the program
# itself reports missing libraries.
have_library() {
    local cache
    have ldconfig || [[ -x /sbin/ldconfig ]] || return 0
    cache=$(PATH=$PATH:/sbin:/usr/sbin ldconfig -p 2>/dev/null) || return 0
    [[ -z $cache || $cache == *"$1"* ]]
}

# True if some Vulkan driver is installed, for hardware or software.
have_vulkan_driver() {
    local folder
    [[ -n ${VK_ICD_FILENAMES:-}${VK_DRIVER_FILES:-} ]] && return 0
    for folder in /usr/share/vulkan/icd.d /etc/vulkan/icd.d /usr/local/share/vulkan/icd.d \
        "${XDG_DATA_HOME:-${HOME:-/root}/.local/share}/vulkan/icd.d" /run/opengl-driver/share/vulkan/icd.d; do
        compgen -G "$folder/*.json" >/dev/null && return 0
    done
    return 1
}

# Missing requirements: parallel lists of Debian packages and of their purposes.
packages=()
reasons=()

need() {
    packages+=("$1")
    reasons+=("$2")
}

# Looks for the requirements of building.
look_for_build_tools() {
    if ! have cc; then
        need gcc "a C linker, which Rust uses"
        need libc6-dev "the C library to link with"
    fi
}

# Looks for the requirements of drawing with Vulkan and opening a window. macOS has both.
look_for_graphics() {
    [[ $(uname -s) == Linux ]] || return 0
    have_library libvulkan.so.1 || need libvulkan1 "the Vulkan loader"
    have_vulkan_driver || need mesa-vulkan-drivers "Vulkan drivers, one of which draws in software"
    have_library libxkbcommon-x11.so.0 || need libxkbcommon-x11-0 "the keyboard in windows"
    have_library libX11-xcb.so.1 || need libx11-xcb1 "windows under X11"
    have_library libXcursor.so.1 || need libxcursor1 "the mouse pointer"
    have_library libXi.so.6 || need libxi6 "mouse and keyboard"
    have_library libwayland-client.so.0 || need libwayland-client0 "windows under Wayland"
}

# True if EGL finds a driver.
have_egl_driver() {
    local folder
    for folder in /usr/share/glvnd/egl_vendor.d /etc/glvnd/egl_vendor.d /run/opengl-driver/share/glvnd/egl_vendor.d; do
        compgen -G "$folder/*.json" >/dev/null && return 0
    done
    return 1
}

# Looks for the requirements of the OpenGL program that the lab is raced against.
look_for_opengl() {
    [[ $(uname -s) == Linux ]] || return 0
    have_library libEGL.so.1 || need libegl1 "OpenGL without a window, to race against"
    have_egl_driver || need libegl-mesa0 "the driver for it"
    compgen -G "/usr/lib/*/dri/swrast_dri.so" >/dev/null || have_library libgallium ||
        need libgl1-mesa-dri "OpenGL in software"
}

# Looks for a virtual screen, for the tests of the window.
look_for_virtual_screen() {
    [[ $(uname -s) == Linux ]] || return 0
    have Xvfb || need xvfb "a virtual screen for the tests of the window"
}

# Looks for other compilers of shaders, for the tests of exports.
look_for_shader_compilers() {
    [[ $(uname -s) == Linux ]] || return 0
    have glslangValidator || need glslang-tools "a second opinion on exported GLSL and HLSL"
    have spirv-val || need spirv-tools "a second opinion on exported SPIR-V"
}

# Looks for a browser, for the tests of web pages.
look_for_browser() {
    [[ $(uname -s) == Linux ]] || return 0
    have chromium || need chromium "a browser for the tests of web pages"
    have chromedriver || need chromium-driver "the same, driven by tests"
}

# Looks for the validator of desktop entries, for the tests of packages.
look_for_desktop() {
    [[ $(uname -s) == Linux ]] || return 0
    have desktop-file-validate || need desktop-file-utils "to validate the desktop entry"
}

# Looks for Python with environments, for the Python package.
look_for_python() {
    have python3 || need python3 "Python, for its package"
    have python3 && python3 -c 'import ensurepip, venv' 2>/dev/null || need python3-venv "virtual environments for Python"
}

run_or_show() {
    if [[ ${LCM_DRY_RUN:-} == 1 ]]; then
        say "would run: $*"
    else
        "$@" >&2
    fi
}

# Installs missing packages, or says what to install.
install_missing() {
    ((${#packages[@]})) || return 0
    local i
    local as_root=()
    say "Missing on this machine:"
    for i in "${!packages[@]}"; do
        say "  ${packages[i]}: ${reasons[i]}"
    done
    if ! have apt-get; then
        say_elsewhere
        return 0
    fi
    if ((EUID != 0)); then
        if ! have sudo; then
            say "Installing needs root, and there is no sudo. As root, run:"
            say "  apt-get install --no-install-recommends ${packages[*]}"
            exit 1
        fi
        as_root=(sudo)
    fi
    say "Installing with apt-get:"
    run_or_show "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
    run_or_show "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -q -y --no-install-recommends "${packages[@]}"
}

# The same packages under the names of other systems.
say_elsewhere() {
    if have dnf; then
        say "Fedora: sudo dnf install gcc vulkan-loader mesa-vulkan-drivers libxkbcommon-x11 libX11-xcb \\"
        say "          libXcursor libXi libwayland-client xorg-x11-server-Xvfb glslang spirv-tools chromium chromedriver python3 desktop-file-utils"
    elif have pacman; then
        say "Arch: sudo pacman -S --needed gcc vulkan-icd-loader vulkan-swrast libxkbcommon-x11 libx11 \\"
        say "        libxcursor libxi wayland xorg-server-xvfb glslang spirv-tools chromium python desktop-file-utils"
    elif have zypper; then
        say "openSUSE: sudo zypper install gcc libvulkan1 libvulkan_lvp libxkbcommon-x11-0 libX11-xcb1 \\"
        say "            libXcursor1 libXi6 libwayland-client0 xorg-x11-server-Xvfb glslang-devel spirv-tools chromium chromedriver python3 desktop-file-utils"
    elif [[ $(uname -s) == Darwin ]]; then
        say "macOS: xcode-select --install"
    else
        say "Please install the equivalents with your system's package manager."
    fi
    say "Continuing without; anything that fails for lack of them will say so."
}

# Rust installs per user, not per machine, so installing it is the user's decision.
require_rust() {
    local cargo_home=${CARGO_HOME:-${HOME:-/root}/.cargo}
    if ! have cargo && [[ -x $cargo_home/bin/cargo ]]; then
        PATH=$cargo_home/bin:$PATH
    fi
    if ! have cargo; then
        say "Rust is missing. Install it from https://rustup.rs, then run this again."
        exit 1
    fi
}

# Graphical programs expect a private folder; without one Mesa and the window library complain.
ensure_runtime_folder() {
    if [[ -z ${XDG_RUNTIME_DIR:-} || ! -d ${XDG_RUNTIME_DIR:-} ]]; then
        XDG_RUNTIME_DIR=$(mktemp -d "${TMPDIR:-/tmp}/lcm-runtime.XXXXXX")
        chmod 700 "$XDG_RUNTIME_DIR"
        export XDG_RUNTIME_DIR
        trap 'rm -rf "$XDG_RUNTIME_DIR"' EXIT
    fi
}
