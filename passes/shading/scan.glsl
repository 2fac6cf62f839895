// SPDX-License-Identifier: MIT
// Sums over the invocations of a work group, in their order. The includer has declared `group`, how many
// those are.
shared uint before[group];

// Sum of `value` over the invocations before this one, and over all.
uint scan(uint value, out uint all)
{
    uint me = gl_LocalInvocationIndex;
    before[me] = value;
    barrier();
    for (uint step_ = 1; step_ < group; step_ *= 2) {
        uint left = me >= step_ ? before[me - step_] : 0;
        barrier();
        before[me] += left;
        barrier();
    }
    all = before[group - 1];
    uint exclusive = before[me] - value;
    barrier();
    return exclusive;
}
