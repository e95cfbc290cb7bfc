# What the scripts share that look for something the tests want; to be sourced.

# wanted CHECK NAME PACKAGES: is CHECK true, or can it be made so by installing PACKAGES? NAME is for the message.
wanted() {
    local check=$1 name=$2 packages=$3
    if "$check"; then return 0; fi
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        echo "Installing $name for tests: $packages ..."
        apt-get update -qq || true
        # shellcheck disable=SC2086 - several packages
        DEBIAN_FRONTEND=noninteractive apt-get install -y -qq $packages >/dev/null || true
        if "$check"; then return 0; fi
    fi
    return 1
}

# any_runs PATH...: does any of these programs run? Empty ones are passed over.
any_runs() {
    local path
    for path in "$@"; do
        if [ -x "$path" ] && "$path" --version >/dev/null 2>&1; then return 0; fi
    done
    return 1
}
