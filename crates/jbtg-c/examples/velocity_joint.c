/* A velocity-commanded joint with position limits: a command at 20 Hz, samples at 1 kHz, as CSV on standard output. */

#include <stdio.h>

#include "jbtg.h"

static int fail(const char *what, jbtg_status status) {
    fprintf(stderr, "%s: %s\n", what, jbtg_status_text(status));
    return 1;
}

int main(void) {
    const jbtg_spec spec = {
        .limits = {
            .position = {0.14, 0.50},   /* m */
            .velocity = {-0.15, 0.10},  /* m/s */
            .acceleration = {-1.0, 0.5},/* m/s^2 */
            .jerk = {-100.0, 100.0},    /* m/s^3 */
        },
        .period = 0.05,                 /* s */
        .shape = JBTG_SMOOTHSTEP,
        .timing = JBTG_STRETCHED,
    };
    jbtg_joint joint;
    jbtg_status status = jbtg_joint_init(&joint, &spec);
    if (status != JBTG_STATUS_OK) return fail("limits", status);

    jbtg_sampler sampler;
    status = jbtg_sampler_init(&sampler, &joint, 50, 0.30);
    if (status != JBTG_STATUS_OK) return fail("sampler", status);

    printf("tick,position,velocity,acceleration,jerk\n");
    for (int period = 0; period < 200; period++) {
        jbtg_state now;
        status = jbtg_sampler_upcoming(&sampler, &now);
        if (status != JBTG_STATUS_OK) return fail("state", status);
        /* An operator pushes against the upper limit, then against the lower one, harder than is possible, and leaves
         * for the last second: without a command the joint brakes. */
        if (period < 180) {
            jbtg_command command;
            status = jbtg_command_velocity(&joint, now.position, now.velocity, period < 100 ? 1.0 : -1.0, &command);
            if (status != JBTG_STATUS_OK) return fail("range", status);
            status = jbtg_sampler_command(&sampler, command.velocity);
            if (status != JBTG_STATUS_OK) return fail("command", status);

            /* Exact extrema of the step to come, its interior included. */
            jbtg_step step;
            jbtg_extrema extrema;
            status = jbtg_plan(&joint, now.position, now.velocity, command.velocity, &step);
            if (status == JBTG_STATUS_OK) status = jbtg_step_extrema(&step, &extrema);
            if (status != JBTG_STATUS_OK) return fail("step", status);
            if (extrema.position.max > spec.limits.position.max || extrema.position.min < spec.limits.position.min) {
                fprintf(stderr, "position limit exceeded\n");
                return 1;
            }
        }
        for (int tick = 1; tick <= 50; tick++) {
            jbtg_sample sample;
            status = jbtg_sampler_advance(&sampler, &sample);
            if (status != JBTG_STATUS_OK) return fail("sample", status);
            printf("%d,%.17g,%.17g,%.17g,%.17g\n", period * 50 + tick, sample.state.position, sample.state.velocity,
                   sample.state.acceleration, sample.state.jerk);
        }
    }
    return 0;
}
