"""Every system call of Linux, and whether a submission may make it.

Reviewed up to number `REVIEWED` (from 403 on, a number means the same call on every processor).
A call that stands in no table is refused as unknown, like one that the kernel does not have yet:
a new kernel brings nothing in. To raise the number, read what the new calls do, write each into a
table below, and set `REVIEWED` to the last. A test compares the tables with the kernel's headers
and with libseccomp.
"""

from __future__ import annotations

REVIEWED = 469  # file_setattr, Linux 6.17

# What touches nothing but the worker itself, or reads.
ALLOWED = {
    "memory": "brk mmap mmap2 munmap mprotect mremap madvise msync mlock mlock2 munlock mlockall "
    "munlockall pkey_mprotect pkey_alloc pkey_free map_shadow_stack mseal mbind set_mempolicy "
    "get_mempolicy set_mempolicy_home_node membarrier cacheflush riscv_flush_icache",
    "threads": "futex futex_time64 futex_waitv futex_wake futex_wait futex_requeue set_robust_list "
    "get_robust_list set_tid_address rseq gettid arch_prctl set_thread_area get_thread_area "
    "set_tls get_tls usr26 usr32 sched_yield sched_getaffinity sched_getparam sched_getscheduler "
    "sched_getattr sched_get_priority_max sched_get_priority_min sched_rr_get_interval "
    "sched_rr_get_interval_time64 getcpu getpriority ioprio_get exit exit_group restart_syscall "
    "swapcontext riscv_hwprobe wait4 waitid waitpid",
    "signals that it receives": "rt_sigaction rt_sigprocmask rt_sigpending rt_sigreturn "
    "rt_sigsuspend rt_sigtimedwait rt_sigtimedwait_time64 sigaltstack signalfd signalfd4 pause "
    "sigaction sigprocmask sigpending sigreturn sigsuspend signal sgetmask ssetmask breakpoint",
    "open descriptors": "read write pread64 pwrite64 readv writev preadv pwritev preadv2 pwritev2 "
    "lseek _llseek close close_range dup dup2 dup3 pipe pipe2 poll ppoll ppoll_time64 select "
    "_newselect pselect6 pselect6_time64 epoll_create epoll_create1 epoll_ctl epoll_wait "
    "epoll_pwait epoll_pwait2 eventfd eventfd2 fsync fdatasync fadvise64 fadvise64_64 "
    "arm_fadvise64_64",
    "looking at files": "stat stat64 lstat lstat64 fstat fstat64 newfstatat fstatat64 statx "
    "oldstat oldlstat oldfstat access faccessat faccessat2 readlink readlinkat getdents getdents64 "
    "readdir statfs statfs64 fstatfs fstatfs64 getcwd umask",
    "time": "time times gettimeofday clock_gettime clock_gettime64 clock_getres "
    "clock_getres_time64 nanosleep clock_nanosleep clock_nanosleep_time64 getitimer setitimer "
    "alarm timer_create timer_settime timer_settime64 timer_gettime timer_gettime64 "
    "timer_getoverrun timer_delete timerfd_create timerfd_settime timerfd_settime64 "
    "timerfd_gettime timerfd_gettime64",
    "who and where it is": "getpid getppid getpgid getpgrp getsid getuid getuid32 geteuid "
    "geteuid32 getgid getgid32 getegid getegid32 getresuid getresuid32 getresgid getresgid32 "
    "getgroups getgroups32 capget getrlimit ugetrlimit getrusage sysinfo uname oldolduname "
    "olduname getrandom",
}
# Refused with EPERM, which Python raises as PermissionError.
REFUSED = {
    "network": "socket socketpair connect bind listen accept accept4 sendto recvfrom sendmsg "
    "recvmsg sendmmsg recvmmsg recvmmsg_time64 send recv shutdown getsockname getpeername "
    "setsockopt getsockopt socketcall",
    "processes": "fork vfork execve execveat unshare setns setsid setpgid",
    "signals": "kill tkill tgkill rt_sigqueueinfo rt_tgsigqueueinfo pidfd_send_signal",
    "other processes": "ptrace process_vm_readv process_vm_writev process_madvise "
    "process_mrelease kcmp pidfd_open pidfd_getfd sched_setaffinity sched_setattr sched_setparam "
    "sched_setscheduler setpriority nice ioprio_set perf_event_open bpf userfaultfd migrate_pages "
    "move_pages",
    # A change of user takes back the signal that ends a worker with its grader.
    "rights and limits": "setuid setuid32 setgid setgid32 setreuid setreuid32 setregid setregid32 "
    "setresuid setresuid32 setresgid setresgid32 setfsuid setfsuid32 setfsgid setfsgid32 "
    "setgroups setgroups32 capset setrlimit seccomp landlock_create_ruleset landlock_add_rule "
    "landlock_restrict_self lsm_set_self_attr lsm_get_self_attr lsm_list_modules",
    "memory outside the limit": "shmget shmat shmctl shmdt msgget msgsnd msgrcv msgctl semget "
    "semop semctl semtimedop semtimedop_time64 ipc mq_open mq_unlink mq_timedsend "
    "mq_timedsend_time64 mq_timedreceive mq_timedreceive_time64 mq_notify mq_getsetattr "
    "memfd_create memfd_secret",
    "files": "creat truncate truncate64 ftruncate ftruncate64 fallocate mkdir mkdirat mknod "
    "mknodat rmdir unlink unlinkat rename renameat renameat2 link linkat symlink symlinkat chmod "
    "fchmod fchmodat fchmodat2 chown chown32 fchown fchown32 lchown lchown32 fchownat utime utimes "
    "utimensat utimensat_time64 futimesat flock copy_file_range sendfile sendfile64 splice tee "
    "vmsplice chdir fchdir",
    "attributes of files": "setxattr lsetxattr fsetxattr setxattrat removexattr lremovexattr "
    "fremovexattr removexattrat getxattr lgetxattr fgetxattr getxattrat listxattr llistxattr "
    "flistxattr listxattrat file_getattr file_setattr quotactl quotactl_fd",
    "watching files": "inotify_init inotify_init1 inotify_add_watch inotify_rm_watch "
    "fanotify_init fanotify_mark name_to_handle_at open_by_handle_at mincore cachestat "
    "lookup_dcookie",
    "file systems": "mount umount umount2 mount_setattr pivot_root chroot fsopen fsmount fsconfig "
    "fspick move_mount open_tree open_tree_attr statmount listmount sysfs ustat swapon swapoff "
    "sync syncfs sync_file_range sync_file_range2 arm_sync_file_range readahead",
    "machine": "reboot sethostname setdomainname init_module finit_module delete_module "
    "create_module get_kernel_syms query_module kexec_load kexec_file_load add_key request_key "
    "keyctl acct syslog personality settimeofday clock_settime clock_settime64 adjtimex "
    "clock_adjtime clock_adjtime64 stime vhangup iopl ioperm modify_ldt vm86 vm86old "
    "pciconfig_iobase pciconfig_read pciconfig_write s390_pci_mmio_read s390_pci_mmio_write "
    "s390_runtime_instr s390_guarded_storage s390_sthyi rtas spu_create spu_run subpage_prot "
    "switch_endian sysmips multiplexer",
    "ways round this filter": "io_uring_setup io_uring_enter io_uring_register io_setup "
    "io_destroy io_submit io_cancel io_getevents io_pgetevents io_pgetevents_time64 "
    "remap_file_pages syscall",
}
# Answered with ENOSYS. The C library falls back on older calls than the first two, whose arguments
# a filter can see; the others are gone from Linux, or serve the kernel's own traps.
UNKNOWN = (
    "clone3 openat2 "
    "_sysctl afs_syscall bdflush break epoll_ctl_old epoll_wait_old ftime getpmsg gtty idle lock "
    "mpx nfsservctl prof profil putpmsg security stty tuxcall ulimit uselib vserver uretprobe "
    "uprobe timerfd cachectl sys_debug_setcontext"
)
# Allowed with some arguments: `syscall_filter` says which.
BY_ARGUMENT = "clone open openat fcntl fcntl64 ioctl prctl prlimit64"


def decisions() -> dict[str, str]:
    """For each call "allowed", "refused", "unknown" or "by argument"."""
    found: dict[str, str] = {}
    tables = {
        "allowed": ALLOWED.values(),
        "refused": REFUSED.values(),
        "unknown": (UNKNOWN,),
        "by argument": (BY_ARGUMENT,),
    }
    for decision, groups in tables.items():
        for name in " ".join(groups).split():
            if name in found:
                raise AssertionError(f"{name}: {found[name]} and {decision}")
            found[name] = decision
    return found
