# Run by gdb (tests/gdb.sh): steps through the first call of a routine of each unit, and checks at every instruction
# that the debugger finds the caller. Prints "ok NAME" or "FAIL NAME: reason".
import os

import gdb

STEPS = 20000
WHOLE_STACK_EACH = 25  # instructions
UNITS = ("vertex", "setup", "pixel")
PRESERVED = ("rbx", "rbp", "r12", "r13", "r14", "r15")  # callee-saved registers


class Wrong(Exception):
    pass


def expect(condition, reason):
    if not condition:
        raise Wrong(reason)


def command(text):
    return gdb.execute(text, to_string=True)


def stack_names():
    names, frame = [], gdb.newest_frame()
    while frame:
        names.append(frame.name())
        frame = frame.older()
    return names


def find_routine(unit):
    found = [s for s in command("rbreak ^triptych_%s_" % unit).split() if s.startswith("triptych_%s_" % unit)]
    command("delete")
    expect(found, "no routine of that unit has a name")
    return found[0].split("(")[0]


def registers(frame):
    return [int(frame.read_register(name)) for name in PRESERVED]


def check_frame(name, caller, stack_pointer, values, step):
    frame = gdb.newest_frame()
    expect(frame.name() == name, "instruction %d is in %s" % (step, frame.name()))
    older = frame.older()
    expect(older and older.is_valid(), "instruction %d has no caller" % step)
    expect(older.pc() == caller,
           "instruction %d: the caller is at %#x, expected %#x" % (step, older.pc(), caller))
    expect(int(older.read_register("rsp")) == stack_pointer,
           "instruction %d: the caller's stack pointer" % step)
    expect(registers(older) == values, "instruction %d: a register of the caller" % step)
    if step % WHOLE_STACK_EACH == 0:
        expect("command_line_run" in stack_names(),
               "instruction %d: the stack ends at %s" % (step, stack_names()[-1]))


def step_through(name):
    command("tbreak *(char *)&%s" % name)
    command("continue")
    start = gdb.newest_frame()
    expect(start.name() == name, "the breakpoint stops in %s" % start.name())
    callers = stack_names()[1:3]
    # Without optimisation, the function that chooses a code of the routine is between them.
    expect(callers[0] == "routine_run" or callers == ["run_either", "routine_run"], "the callers are %s" % callers)
    caller = start.older().pc()
    stack_pointer = int(start.read_register("rsp")) + 8
    values = registers(start)
    lines = set()
    for step in range(STEPS):
        if gdb.newest_frame().pc() == caller:
            break
        check_frame(name, caller, stack_pointer, values, step)
        position = gdb.newest_frame().find_sal()
        if position.symtab:
            lines.add((position.symtab.filename, position.line))
        command("stepi")
    expect(gdb.newest_frame().pc() == caller, "the routine does not return")
    expect(int(gdb.parse_and_eval("$rsp")) == stack_pointer, "the stack pointer after the return")
    return lines, step


def check_lines(unit, engine, lines):
    folders = {"/".join(file.split("/")[:-1]) for file, line in lines}
    wanted = "asm/stitch" if engine == "stitch" else "src/spec/" + unit
    expect(wanted in folders, "no line of %s, only of %s" % (wanted, folders))
    file, line = sorted(l for l in lines if l[0].startswith(wanted + "/"))[0]
    expect("starts at address" in command("info line %s:%d" % (file, line)), "info line %s:%d" % (file, line))
    expect(str(line) in command("list %s:%d,%d" % (file, line, line)), "list %s:%d" % (file, line))


def check_unit(unit, engine):
    name = find_routine(unit)
    lines, steps = step_through(name)
    expect(steps > 50, "only %d instructions" % steps)
    check_lines(unit, engine, lines)
    return steps


engine = os.environ["ENGINE"]
for setting in ("pagination off", "confirm off", "breakpoint pending on", "width 0", "print thread-events off",
                "environment TRIPTYCH_DEBUG=gdb"):
    command("set " + setting)
command("tbreak queue_render")
command("run")
for unit in UNITS:
    test = "gdb finds the caller of a %s routine of %s at every instruction" % (unit, engine)
    try:
        steps = check_unit(unit, engine)
        print("ok %s" % test)
    except (Wrong, gdb.error) as reason:
        print("FAIL %s: %s" % (test, reason))
try:
    command("delete")
    command("continue")
    ended = gdb.parse_and_eval("$_exitcode")
    print("ok" if ended == 0 else "FAIL", "a render with %s ends normally after stepping" % engine)
except gdb.error as reason:
    print("FAIL a render with %s ends normally after stepping: %s" % (engine, reason))
