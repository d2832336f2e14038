# Subtracts callgrind's profiles of two streams. The second stream has 10 slots more. Prints the instructions,
# loads from memory, and conditional or indirect jumps of one slot for four pixels, by parts of the text.
#
#   awk -v groups=N -f profile.awk FEW MANY
#
# N is the number of groups of four pixels. The profiles have the events Ir Dr Dw ... Bc Bcm Bi Bim, and no
# compressed names or positions.
BEGIN {
    part["shader_flow.h"] = part["shader_execute.h"] = "the walk and the switch"
    part["shader.h"] = part["table.c"] = part["program_flow.c"] = part["program.h"] = "operands and the result"
    part["shader_arithmetic.h"] = part["shader_function.h"] = "the instruction itself"
    part["quad.h"] = part["bind.h"] = part["op.def"] = "arithmetic, moves of vectors"
}
/^f[lie]=/ {
    count = split($0, path, "/")
    name = part[path[count]]
    next
}
/^calls=/ { getline; next } # the next line is the cost of the called function, counted there
/^[0-9]/ && name != "" {
    sign = FILENAME == ARGV[1] ? -1 : 1
    instructions[name] += sign * $2
    loads[name] += sign * $3
    jumps[name] += sign * ($11 + $13)
}
END {
    format = "%-30s %12s %8s %10s\n"
    printf format, "of one lrp, four pixels", "instructions", "loads", "decisions"
    rows = split("the walk and the switch;operands and the result;the instruction itself;arithmetic, moves of vectors", row, ";")
    for (i = 1; i <= rows; i++) {
        name = row[i]
        printf format, name, rounded(instructions[name]), rounded(loads[name]), rounded(jumps[name])
        all[1] += instructions[name]
        all[2] += loads[name]
        all[3] += jumps[name]
    }
    printf format, "sum", rounded(all[1]), rounded(all[2]), rounded(all[3])
}
function rounded(sum)
{
    return sprintf("%.0f", sum / 10 / groups)
}
