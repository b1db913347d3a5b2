"""Texts written by hand for these tests, and what each says: ``text | attribute=value ...``; ``-`` is None."""

TABLE = """
left hook | arm=left action=punch turn_side=-
right jab | arm=right action=punch
dance | action=dance turn=-
about face | turn=around turn_side=-
left about face | turn=around turn_side=left
kick | action=kick foot_lift=one
left kick | leg=left foot_lift=left arm=-
a high kick with the right leg | leg=right foot_lift=right arm=-
a man kicks a ball with his left foot | leg=left foot_lift=left
spin | path=spin
spins to the left | path=spin path_side=left
twirls clockwise on one spot | path=spin path_side=right
a dancer spins counterclockwise | path=spin path_side=left
pirouette | path=spin action=dance
turn left | turn=turn turn_side=left
turn right | turn=turn turn_side=right
she turns to her left | turn=turn turn_side=left
a quick right turn | turn=turn turn_side=right
pivot left | turn=turn turn_side=left
turns ninety degrees right | turn=turn turn_side=right
he turns around | turn=around turn_side=-
turns around to the left and stops | turn=around turn_side=left
u-turn | turn=around
a u-turn to the right | turn=around turn_side=right
a half turn to the left | turn=around turn_side=left
turns 180 degrees | turn=around
a full turn to the right | path=spin path_side=right turn=full
turns right away | turn_side=-
sits down right after that | turn_side=- posture_end=sitting
stands right there | turn_side=- arm=-
all right, she walks | turn_side=-
the man has left the room | turn_side=-
walk in a circle | path=circle path_side=- travel=forward
walks in a circle to the left | path=circle path_side=left
runs a clockwise circle | path=circle path_side=right speed=run
jogs counter-clockwise in a ring | path=circle path_side=left
walks along a curve to the right | path=curve path_side=right
curving left | path=curve path_side=left
veers to the right while running | path=curve path_side=right
walks straight ahead | turn=none path=straight travel=forward
a person walks in a straight line | path=straight travel=forward
walk forward without turning | turn=none travel=forward
he turns left and then right | turn_side=-
looks to the left | turn=- turn_side=-
circles the right arm | path=- arm=right
rotates the left wrist | turn=- path=- arm=left
twists the torso from side to side | path=- turn=-
hip circles | path=-
walk cycle | path=- speed=walk
walks forward | travel=forward steps=along
walk backwards | travel=backward
backing up slowly | travel=backward pace=slow
she backs away | travel=backward
retreats | travel=backward
takes three steps back | travel=backward
moonwalk | travel=backward
sidestep | travel=sideways
side steps to the left | travel=left
sidesteps right | travel=right
shuffles sideways to the right | travel=right
moves sideways | travel=sideways
strafe left | travel=left
steps to the left | travel=left
hops to the right | travel=right
marching in place | travel=none steps=in place
jog on the spot | travel=none steps=in place
walks on a treadmill | travel=none steps=in place
walks forward, then walks backward | travel=-
stands still | still=True travel=none speed=still arms_move=1 legs_move=1
idle | still=True speed=still
motionless | still=True
a person stays without moving | still=True
walks without moving the arms | still=- travel=forward
sprint | speed=run
a woman runs quickly | speed=run pace=fast
jogging | speed=jog
an old man walks | speed=slow
walks slowly | speed=slow pace=slow
walks quickly | speed=- pace=fast
sneaks forward | speed=slow action=sneak
a casual stroll | speed=walk
runs in place | speed=- travel=none
waves | arms_up=one action=wave
wave with the right hand | arms_up=right arm=right
he waves his left hand | arms_up=left arm=left
waves both hands | arms_up=both arm=both
raise the left arm | arms_up=left arm=left
lifts the right hand high above the head | arms_up=right arm=right
raises both arms | arms_up=both arm=both
hands up | arms_up=both
puts the hands up in surrender | arms_up=both
arms overhead | arms_up=both
jumping jacks | arms_up=both action=jumping jack jumps=-1
three jumping jacks | jumps=3
salute | arms_up=one
throws with the left hand | arm=left action=throw
a right-handed throw | arm=right action=throw
pitches a baseball | action=throw
punches with both fists | arm=both action=punch
right uppercut | arm=right action=punch
drinks with the right hand | arm=right action=manipulate
claps | claps=-1 hands_together=True
claps twice | claps=2 repeats=2
applauds | claps=-1
prays with palms together | hands_together=True
forehand | action=tennis
left-handed tennis serve | arm=left action=tennis arms_up=left
dribbles a basketball with the left hand | arm=left action=basketball
a right turn while the left hand waves | arm=left turn_side=right
swings the arms | arm=both
lifts the left knee | leg=left foot_lift=left
raises the right leg to the side | leg=right foot_lift=right
stands on the left leg | foot_lift=right leg=-
balances on the right foot | foot_lift=left
hops on one leg | foot_lift=one jumps=-1
hops on the left foot three times | jumps=3 foot_lift=right
high knees | foot_lift=both
steps over a box | foot_lift=one
lunges with the left leg | leg=left posture_lowest=crouching
sits down | posture_start=standing posture_end=sitting level=down
sit | posture_end=sitting
sitting on a chair | posture_start=sitting posture_end=sitting
someone sits cross-legged on the ground | posture_end=sitting
stands up | posture_end=standing level=up
stands up from a chair | posture_start=sitting posture_end=standing level=up
gets up off the floor | posture_end=standing level=up
rises from a kneeling position | posture_start=kneeling posture_end=standing level=up
gets up from lying on the back | posture_start=lying posture_end=standing level=up
sits down and stands up again | posture_start=standing posture_end=standing level=down and up posture_lowest=sitting
lies down | posture_start=standing posture_end=lying level=down
lie down on the floor | posture_end=lying
falls over | posture_end=lying posture_start=standing
collapses to the ground | posture_end=lying
the arms fall to the sides | posture_end=- posture_lowest=-
lays bricks | posture_lowest=-
is sleeping | posture_start=lying posture_end=lying
kneels down | posture_start=standing posture_end=kneeling level=down
drops to one knee | posture_end=kneeling level=down
kneeling in prayer | posture_start=kneeling
crawl | posture_start=crawling posture_end=crawling posture_lowest=crawling hands_low=True
crawls on hands and knees | posture_lowest=crawling action=crawl
push-ups | posture_lowest=crawling action=stretch
squats | posture_lowest=crouching level=down and up
crouches down | posture_lowest=crouching
ducks under a bar | posture_lowest=crouching
walks crouched | posture_lowest=crouching
crouched walking | posture_start=crouching posture_lowest=crouching
bows | lean=True action=bow
bends forward | lean=True
takes a bow | lean=True
draws a bow and arrow | lean=-
touches the toes | lean=True hands_low=True
picks up a box | hands_low=True action=pick up
picks something up from the floor with the left hand | hands_low=True arm=left
cartwheel | posture_lowest=upside down action=cartwheel
a handstand | posture_lowest=upside down arms_up=both
back flip | posture_lowest=upside down action=flip
flips around | posture_lowest=- turn=around
jump | jumps=1 action=jump
jumps twice | jumps=2
two jumps | jumps=2
leaps over a puddle | jumps=1
jumps up and down | jumps=-1
keeps hopping | jumps=-1
jumps 5 times | jumps=5
skips rope | jumps=-1
does not jump | jumps=- action=-
walks and never turns | turn=none
walks up the stairs | action=stairs
climbs a ladder | action=stairs
swims | action=swim
pushes a heavy box | action=push
acts like a monkey | action=imitate
plays golf | action=golf
karate | action=fight
points at something with the right arm | arm=right action=gesture
stretches | action=stretch
runs forward, jumps once and lands | jumps=1 travel=forward
Walk Forward! | travel=forward
a very tired person walks home | action=walk
trudges through the snow | speed=slow travel=forward
steps forward with the left foot | leg=left travel=forward
throws a punch with the right hand while stepping to the left | arm=right
quantum chromodynamics | action=-
"""
