/* What goes wrong, and what people do. */

inline kill_gateway(g) {
	gateway[g] = DOWN; latch[g] = 0; held_run[g] = 0; held_goal[g] = 0; sees_run[g] = 0; waiting[g] = 0; current[g] = 0;
	phase[g] = 0; cancelled[g] = 0; stop[g] = 0; confirms[g] = 0; asked_stop[g] = 0; recovers[g] = 0; claim_open[g] = 0;
	claim_run[g] = 0; rearm[g] = 0; holder[g] = 0; writes[g] = 0; outcome[g] = 0; signal[g] = 0; away[g] = 0;
	stopped[g] = (stopped[g] != 0 && (known[g] || g >= MACHINES || heard[machine_of(g)]))
}

inline kill_relay(m) {
	relay[m] = DOWN; serves[m] = 0; answer[m] = 0; relay_new[m] = (leaf[m] == OPEN)
}

inline forget_run(m) {
	runs[m] = 0; leaf[m] = 0; tries[m] = 0; receipt[m] = 0; relay_new[m] = 0; asked_stop[m] = 0; silent[m] = (says[m] != 0)
}

inline forget_duty(m) {
	duty[m] = 0; host_press[m] = 0; away[m] = 0
}

inline unheard(m) { /* a press that a killed gateway and the host agent have forgotten is not known to anybody */
	heard[m] = 0;
	stopped[m] = (latch[m] != LATCHED && !known[m] -> 0 : stopped[m])
}

#define ended(m) (runs[m] == 0 || leaf[m] == ENDS || leaf[m] == STOOD)
#define may_fail (faults < FAULTS)

proctype Trouble(byte g) {
	byte m = machine_of(g);
end:	do
	:: atomic { may_fail && may_kill(gateway[g]) && see(KILLED_GATEWAY, g, 0) -> seen; count(faults); printf("gateway %d is killed\n", g); kill_gateway(g) }
	:: atomic { may_fail && gateway[g] == UP && see(FROZE_GATEWAY, g, 0) -> seen; count(faults); printf("gateway %d is frozen\n", g); gateway[g] = FROZEN }
	:: atomic { gateway[g] == FROZEN -> gateway[g] = UP; printf("gateway %d goes on\n", g);
		if
		:: phase[g] == SENT && stop[g] == 0 -> begin_stop(g, HELD)
		:: true
		fi }
	/* to start takes longer than a lease: the host agent has seen the loss, and messages have arrived or are lost */
	:: atomic { gateway[g] == DOWN && (g >= MACHINES || duty[m] || host != UP) && goal_flies[m] == 0 && see(STARTED_GATEWAY, g, 0) -> seen; printf("gateway %d starts\n", g); start_gateway(g, m) }
	:: atomic { g < MACHINES && may_fail && may_kill(relay[m]) && see(KILLED_RELAY, m, 0) -> seen; count(faults); printf("relay %d is killed\n", m); kill_relay(m) }
	:: atomic { g < MACHINES && may_fail && relay[m] == UP && see(FROZE_RELAY, m, 0) -> seen; count(faults); printf("relay %d is frozen\n", m); relay[m] = FROZEN }
	:: atomic { g < MACHINES && relay[m] == FROZEN -> printf("relay %d goes on\n", m); relay[m] = UP }
	:: atomic { g < MACHINES && relay[m] == DOWN && see(STARTED_RELAY, m, 0) -> seen; printf("relay %d starts\n", m); relay[m] = UP }
	:: atomic { g < MACHINES && may_fail && sick[m] == 0 -> count(faults);
		if
		:: sick[m] = DEAF; printf("machine %d obeys no cancel any more\n", m)
		:: sick[m] = MUTE; printf("machine %d tells nothing any more\n", m)
		fi }
	:: atomic { g < MACHINES && (sick[m] == DEAF || (sick[m] != 0 && EITHER)) -> printf("machine %d is well again\n", m); sick[m] = 0; endless[m] = 0 }
	od
}

proctype People() {
end:	do
	:: atomic { may_fail && may_kill(scheduler) && see(KILLED_SCHEDULER, 0, 0) -> seen; count(faults); printf("the scheduler is killed\n");
		scheduler = DOWN; hears_press = 0; forget_run(0); forget_run(other) }
	:: atomic { may_fail && scheduler == UP && see(FROZE_SCHEDULER, 0, 0) -> seen; count(faults); printf("the scheduler is frozen\n"); scheduler = FROZEN }
	:: atomic { scheduler == FROZEN -> printf("the scheduler goes on\n"); scheduler = UP }
	:: atomic { scheduler == DOWN && see(STARTED_SCHEDULER, 0, 0) -> seen; printf("the scheduler starts\n"); scheduler = UP }
	:: atomic { may_fail && may_kill(host) && see(KILLED_HOST, 0, 0) -> seen; count(faults); printf("the host agent is killed\n");
		host = DOWN; forget_duty(0); forget_duty(other); unheard(0); unheard(other) }
	:: atomic { may_fail && host == UP && see(FROZE_HOST, 0, 0) -> seen; count(faults); printf("the host agent is frozen\n"); host = FROZEN; unheard(0); unheard(other) }
	:: atomic { host == FROZEN -> printf("the host agent goes on\n"); host = UP }
	:: atomic { host == DOWN && see(STARTED_HOST, 0, 0) -> seen; printf("the host agent starts\n"); host = UP }
	:: atomic { presses < PRESSES && see(PRESSED, 0, 0) -> seen; count(presses);
		printf("a person presses stop\n");
		signal[0] = (whole(0) && gateway[0] != DOWN); signal[GATEWAYS - 1] = (whole(machine_of(GATEWAYS - 1)) && gateway[GATEWAYS - 1] != DOWN);
		if
		:: MACHINES > 1 -> signal[other] = (whole(other) && gateway[other] != DOWN)
		:: else
		fi;
		hears_press = (scheduler != DOWN);
		host_press[0] = (whole(0) && host != DOWN); host_press[other] = (whole(other) && host != DOWN);
		heard[0] = (host == UP); heard[other] = (host == UP) }
	:: atomic { hears_press && scheduler == UP && ended(0) && ended(other) -> hears_press = 0 }
	od
}
