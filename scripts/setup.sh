#!/usr/bin/env bash
# Installs what atlaswire needs on Debian 12, from scripts/packages.txt; does nothing when all is there.
# Usage: scripts/setup.sh [--runtime] [--check]
#   --runtime  only what built programs need (lines ending in "run")
#   --check    list what is missing and exit 1; install nothing
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
lines='.'
check=
for option in "$@"; do
  case "$option" in
    --runtime) lines=' run$' ;;
    --check) check=1 ;;
    -h | --help) sed -n '2,5s/^# //p' "$0"; exit 0 ;;
    *) echo "setup.sh: error: unknown option '$option'; see --help" >&2; exit 2 ;;
  esac
done
unpacked=/usr/local/lib/atlaswire/aside
listed() { sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$here/packages.txt" | grep -E "$lines"; }
mapfile -t packages < <(listed | grep -v ' aside$' | sed 's/ run$//')
mapfile -t aside < <(listed | sed -n 's/ aside$//p')
missing=()
missing_aside=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
for package in "${aside[@]}"; do
  [ -e "$unpacked/$package" ] || missing_aside+=("$package")
done
if [ $((${#missing[@]} + ${#missing_aside[@]})) -eq 0 ]; then
  exit 0
fi
if [ -n "$check" ]; then
  printf 'missing: %s\n' "${missing[*]} ${missing_aside[*]}"
  exit 1
fi
sudo=
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup.sh: error: packages are missing and this is not root: run it as root" >&2; exit 1; }
  sudo=sudo
fi
echo "installing $((${#missing[@]} + ${#missing_aside[@]})) packages: ${missing[*]} ${missing_aside[*]}"
export DEBIAN_FRONTEND=noninteractive
$sudo apt-get update -q
[ ${#missing[@]} -eq 0 ] || $sudo apt-get install -y -q --no-install-recommends "${missing[@]}"
if [ ${#missing_aside[@]} -gt 0 ]; then
  folder=$(mktemp -d)
  trap 'rm -rf "$folder"' EXIT
  (cd "$folder" && apt-get download -q -o APT::Sandbox::User=root "${missing_aside[@]}")
  $sudo mkdir -p "$unpacked"
  for package in "${missing_aside[@]}"; do
    $sudo dpkg -x "$folder/$package"_*.deb "$unpacked"
    $sudo touch "$unpacked/$package"
  done
fi
