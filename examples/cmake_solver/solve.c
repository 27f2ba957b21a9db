/* Place the tip, then find every configuration that takes it there. */
#include <stdio.h>

#include "arm.h"

int main(void)
{
    double q[ARM_JOINTS], T[16];
    arm_solutions found;

    for (int i = 0; i < ARM_JOINTS; i++) {
        q[i] = 0.2 + 0.1 * i;
    }
    arm_fk(q, T);
#if ARM_HAS_WORKSPACE
    static arm_workspace work;
    arm_prepare(&work);
    arm_ik_near(T, q, false, &work, &found);
#else
    arm_ik_near(T, q, false, &found);
#endif
    for (int k = 0; k < found.count; k++) {
        for (int i = 0; i < ARM_JOINTS; i++) {
            printf("%10.5f", found.q[k][i]);
        }
        printf("   residual %.0e\n", found.residual[k]);
    }
    return found.count > 0 ? 0 : 1;
}
