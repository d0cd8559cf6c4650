"""Where the figures of a bench go: a file of JSON, a line of a history, each with the machine and the time."""
import json, os, platform, time


def add_options(parser):
    parser.add_argument("--json", help="file for the figures")
    parser.add_argument("--history", help="a line of JSON is added to it")


def machine():
    return {"machine": platform.processor() or platform.machine(), "cores": os.cpu_count(), "load": os.getloadavg()[0],
            "time": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())}


def keep(options, result):
    """`result` has machine() in it, as it was when the bench began or ended."""
    if options.json:
        with open(options.json, "w") as file:
            json.dump(result, file, indent=1)
    if options.history:
        with open(options.history, "a") as file:
            file.write(json.dumps(result) + "\n")
