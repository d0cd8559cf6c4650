#!/usr/bin/env bash
# run.sh DUBSAR: talks to the software that other people wrote for the same devices, as far as it is installed, and prints
# a table. Ends with 0 when all that could be tried agreed, with 1 otherwise; what is missing is said, not counted.
set -uo pipefail
dubsar=$(readlink -f "$1")
here=$(dirname "$(readlink -f "$0")")
work=$(mktemp -d)
started=()
trap 'for p in "${started[@]}"; do kill "$p" 2>/dev/null; done; wait 2>/dev/null; rm -rf "$work"' EXIT
failed=0
port=$((20000 + RANDOM % 20000))

row() { printf '%-34s %-8s %s\n' "$1" "$2" "$3"; }
good() { row "$1" agrees "$2"; }
bad() { row "$1" DIFFERS "$2"; failed=1; }
missing() { row "$1" missing "$2"; }
have() { command -v "$1" >/dev/null 2>&1; }
# begin NAME COMMAND...: in the background, its output in work/NAME
begin() { local name=$1; shift; "$@" >"$work/$name" 2>&1 & started+=($!); last=$!; }
end() { kill "$1" 2>/dev/null; wait "$1" 2>/dev/null; }
# wait_for FILE TEXT: up to 5 s
wait_for() { for _ in $(seq 50); do grep -q "$2" "$work/$1" 2>/dev/null && return 0; sleep .1; done; return 1; }

# the daemon that was begun here has its socket; up to 5 s
wait_for_socket() { for _ in $(seq 50); do [ -S /var/run/spnav.sock ] && return 0; sleep .1; done; return 1; }

row PEER RESULT FIGURES

# libspnav, a client, before the simulated daemon
if ! have cc || ! echo '#include <spnav.h>' | cc -E - >/dev/null 2>&1; then
  missing "libspnav client" "apt install libspnav-dev gcc"
elif ! cc -o "$work/spnav_client" "$here/spnav_client.c" -lspnav -lm 2>"$work/cc"; then
  bad "libspnav client" "does not compile: $(head -1 "$work/cc")"
else
  begin spacenavd_sim "$dubsar" devices simulate spacenav --live --socket "$work/spnav.sock" --seconds 20 --seed 3
  server=$last
  wait_for spacenavd_sim "simulated spacenav"
  if told=$(SPNAV_SOCKET=$work/spnav.sock "$work/spnav_client" 8); then good "libspnav client" "$told"; else bad "libspnav client" "$told"; fi
  end "$server"
fi

# spacenavd, the daemon: the greeting; motions need a puck. Debian's binds run/spnav.sock where it is started.
if ! have spacenavd; then
  missing "spacenavd daemon" "apt install spacenavd"
elif [ ! -S /var/run/spnav.sock ] && { [ "$(id -u)" -ne 0 ] || ! begin spacenavd env -C / spacenavd -d || ! wait_for_socket; }; then
  missing "spacenavd daemon" "installed, but it does not run: systemctl start spacenavd"
elif told=$("$dubsar" devices probe spacenav --json "$work/probe.json" 2>&1); then
  good "spacenavd daemon" "$(head -1 <<<"$told")"
else
  bad "spacenavd daemon" "$(tail -1 <<<"$told")"
fi

# VRPN's own client before the simulated server, over TCP and called back by UDP
if ! have vrpn_print_devices; then
  missing "vrpn_print_devices" "build github.com/vrpn/vrpn (client_src) and put it on PATH"
else
  for way in "tcp://" ""; do
    label="vrpn_print_devices ${way:-by UDP call}"
    begin vrpn_sim "$dubsar" devices simulate vrpn --live --port "$port" --seconds 30
    server=$last
    wait_for vrpn_sim "simulated vrpn"
    timeout 8 stdbuf -oL vrpn_print_devices "Tracker0@${way}127.0.0.1:$port" >"$work/client" 2>&1
    poses=$(grep -c -i "tracker.*sensor" "$work/client")
    if grep -qi "no response" "$work/client"; then bad "$label" "its pings are not answered ($poses poses)";
    elif [ "$poses" -ge 100 ]; then good "$label" "$poses poses in 8 s";
    else bad "$label" "$poses poses: $(tail -1 "$work/client")"; fi
    end "$server"
    port=$((port + 1))
  done
fi

# VRPN's own server, read by dubsar; stopped and started again at once on the same port
if ! have vrpn_server; then
  missing "vrpn_server" "build github.com/vrpn/vrpn (server_src) and put it on PATH"
else
  printf 'vrpn_Tracker_NULL Tracker0 2 60.0\n' >"$work/vrpn.cfg"
  for turn in first again; do
    begin "vrpn_server_$turn" vrpn_server -f "$work/vrpn.cfg" "$port"
    server=$last
    sleep 1
    told=$("$dubsar" devices monitor vrpn --address localhost --port "$port" --seconds 4 --json "$work/monitor.json" 2>&1 >/dev/null)
    samples=$(sed -n 's/.*"samples": *\([0-9]*\).*/\1/p' "$work/monitor.json" | head -1)
    # standing still at the origin: 60 poses a second
    if [ "${samples:-0}" -ge 150 ]; then good "vrpn_server, $turn" "$samples poses in 4 s"; else bad "vrpn_server, $turn" "${samples:-0} poses: $told"; fi
    end "$server"
  done
fi

# opentrack has no mode without a window: it is listened to where somebody has started it
if ! have opentrack; then
  missing "opentrack" "https://github.com/opentrack/opentrack; also AITrack, XRLinuxDriver"
elif ! pgrep -x opentrack >/dev/null; then
  missing "opentrack" "installed, not running: start it with output \"UDP over network\" to 127.0.0.1 port 4242"
else
  "$dubsar" devices monitor opentrack --seconds 5 --json "$work/monitor.json" >/dev/null 2>&1
  samples=$(sed -n 's/.*"samples": *\([0-9]*\).*/\1/p' "$work/monitor.json" | head -1)
  if [ "${samples:-0}" -ge 10 ]; then good "opentrack" "$samples poses in 5 s"; else bad "opentrack" "${samples:-0} poses in 5 s"; fi
fi
exit $failed
