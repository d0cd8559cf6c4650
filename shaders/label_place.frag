#version 450 core
// Counts what is seen of a place; draws nothing.

layout(early_fragment_tests) in;
layout(std430, binding = 2) buffer Seen { uint seen[]; };

flat in int counted;

void main() { atomicAdd(seen[counted], 1u); }
