"""Forms of everyday sentences about who is where, what else will do, and what the robot can do."""

import pytest

from evaluation.everyday.notation import verdict
from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import understand


@pytest.mark.parametrize(
    ("context", "said", "right"),
    [
        # For somebody, who is somewhere.
        ("-", "Bring my wife the blue mug, she's in the study.", "put(blue mug, desk)"),
        ("-", "Take the apple to Tom, he's at the desk.", "put(apple, desk)"),
        ("-", "Anna is sitting at the kitchen table, bring her the red mug.", "put(red mug, kitchen table)"),
        ("-", "I'm at the desk, bring me the red mug please.", "put(red mug, desk)"),
        ("-", "Can you bring me the white can? I'm at the desk.", "put(white can, desk)"),
        ("-", "Meet me in the kitchen.", "goto(kitchen)"),
        # What somebody is to be asked, or reminded of.
        ("-", "Ask Peter whether he wants coffee.", "say(Peter do you want coffee)"),
        ("-", "Ask the children in the bedroom if they are hungry.", "goto(bedroom); say(are you hungry)"),
        ("-", "Remind me in five minutes to call my mother.", "wait(300); say(call your mother)"),
        ("-", "Wake me up in ten minutes.", "wait(600); say(wake up)"),
        ("-", "Repeat after me: I am a robot.", "say(I am a robot)"),
        # What else will do.
        ("-", "Bring me a spoon, or if you can't find it, the blue mug.", "fetch(spoon) || fetch(blue mug)"),
        ("-", "Get the green can. If it isn't there, bring me the red one.", "fetch(green can)"),
        ("held:white mug", "Not that one, I want the blue mug.", "put(white mug, desk); fetch(blue mug)"),
        ("held:red mug", "Actually, I want the blue one instead.", "put(red mug, living table); fetch(blue mug)"),
        ("last:bring me the red mug", "Wrong mug. I meant the white one.", "fetch(white mug)"),
        # What is told, and what is asked for.
        ("-", "Get me my vitamins, it's time to take them.", "fetch(orange box)"),
        ("-", "The red ball doesn't belong on the bookshelf, put it in the toy box.", "put(red ball, toy box)"),
        ("-", "the telly's on but the remote's nowhere to be seen, hunt it down", "find(remote)"),
        ("-", "I've left my phone charger somewhere in the bedroom, would you look for it?", "find(phone charger)"),
        ("-", "Take the apple off the kitchen table and put it on the counter for me.", "put(apple, counter)"),
        ("failed:find my glasses", "They may be in the bedroom, please look there.", "goto(bedroom); find(glasses)"),
        # Going somewhere, with something in the hand or to tell what is there.
        ("-", "Pick up the red mug and drive to the kitchen with it.", "take(red mug); goto(kitchen)"),
        ("-", "Pick up the red can, take it into the study and stay there holding it.", "take(red can); goto(study)"),
        ("-", "Drive to the counter and tell me what's on it.", "answer(mug, can, bowl, bottle)"),
        ("-", "Where'd the white bottle end up?", "answer(dresser)"),
        ("-", "Which room has the dresser in it?", "answer(bedroom)"),
        ("-", "There's a mug on the desk, isn't there? What colour is it?", "answer(white)"),
        # At what time.
        ("-", "When forty-five minutes are up, sing out that the cake's done.", "wait(2700); say(the cake's done)"),
        ("-", "One minute from now bring me the apple, not sooner.", "wait(60); fetch(apple)"),
        ("-", "In a quarter of an hour give me a shout that the pie's done.", "wait(900); say(the pie is done)"),
        ("-", "I go to sleep now, in eight minutes please go to your home.", "wait(480); return()"),
        (
            "-",
            "go to the kitchen and tell mum im coming in five minutes",
            "goto(kitchen); say(im coming in five minutes)",
        ),
        ("-", "First you go in kitchen, after you come back here.", "goto(kitchen); return()"),
        # What is named in a speech, as a purpose, or only tells where something stands.
        ("-", "Go to the study and say dinner is on the table.", "goto(study); say(dinner is on the table)"),
        ("-", "Put my notebook next to the white mug so I see it tomorrow.", "put(notebook, desk near white mug)"),
        ("-", "There should be a cloth next to the blue bottle, bring it here please.", "fetch(cloth)"),
        ("-", "I'm on nights this week and can't find my badge, could you look for it?", "find(badge)"),
        (
            "-",
            "Please clear my desk: the white mug goes on the counter and the vitamin box on the bedside table.",
            "put(white mug, counter) & put(orange box, bedside table)",
        ),
        ("last:put the yellow bowl on the kitchen table", "Put the apple there too.", "answer(there already)"),
        ("-", "Would you clean up the coffee table? Just put the things away.", "tidy(living table)"),
        (
            "-",
            "Get the white bottle ready on the desk for me, will you? It's on the dresser.",
            "put(white bottle, desk)",
        ),
        ("-", "Get the paintbrush ready on the counter for me.", "put(paintbrush, counter)"),
        ("-", "Have the red mug ready for me.", "fetch(red mug)"),
        # Rules, names and questions in other words.
        ("-", "From now on the white mug's place is the desk.", "rule(white mug, desk)"),
        ("-", "The rule about the cans no longer applies, you can forget it.", "norule(cans)"),
        ("-", "I don't need the name vitamin box any more, please forget it.", "forget(vitamin box)"),
        ("-", "Does the blue bottle still stand on the counter?", "answer(counter)"),
        ("-", "How many bottles did you see?", "answer(3)"),
        ("-", "Can you cook the soup for us?", "refuse()"),
        ("busy:find a screwdriver", "No rush, mate.", "none()"),
        # All but one, and one for the other.
        (
            "-",
            "Except for the box, everything on the coffee table goes to the kitchen counter.",
            "put(red mug, counter) & put(green can, counter)",
        ),
        (
            "-",
            "Red mug and white mug, let them trade places.",
            "put(red mug, desk) & put(white mug, living table)",
        ),
        # A short `is`, `will` or `would` behind any noun.
        ("-", "the red mug's to go on the desk", "put(red mug, desk)"),
        ("-", "Mum'd like the red mug.", "fetch(red mug)"),
        ("last:put the white box on the bookshelf", "It was fine where it was.", "put(white box, living table)"),
        # Where, more closely.
        ("-", "Move the apple to the counter, next to the bowl.", "put(apple, counter near yellow bowl)"),
        (
            "-",
            "Move the green bottle over to the white one on the dresser.",
            "put(green bottle, dresser near white bottle)",
        ),
        ("-", "Bring me what's left of the bowl on the counter.", "fetch(blue bottle)"),
        ("-", "Put the apple under the table.", "refuse()"),
        ("-", "Bring the apple to the yellow bowl.", "put(apple, counter near yellow bowl)"),
        ("-", "Bring me the ladle from the kitchen, the children are waiting for their soup.", "fetch(ladle)"),
        # Looks, and commands one behind the other.
        ("-", "Look whether the white box is on the coffee table and tell me.", "answer(yes)"),
        ("-", "Count to five, say coming, and go to the study", "wait(5); say(coming); goto(study)"),
        ("held:apple", "Keep it and go to the bedroom.", "goto(bedroom)"),
        # The robot itself.
        ("-", "How much can you carry?", "answer(kilo)"),
        ("-", "How high can you reach?", "answer(metre)"),
        ("-", "Can you go up the stairs?", "refuse()"),
        ("last:bring me the orange box", "In which room did you find it?", "answer(desk)"),
        ("-", "Something to drink out of, please.", "fetch(red mug)"),
        ("-", "I need something to write with.", "fetch(pen)"),
        ("which:yellow block|blue block", "I need the bigger block.", "pick(yellow block)"),
        # What is missed, and where it perhaps is.
        ("-", "The remote's vanished, probably under a cushion, go and look for it.", "find(remote)"),
        ("-", "My keys are gone, perhaps on the sofa, can you find them?", "goto(sofa); find(keys)"),
        ("-", "I can't find my phone, it must be in the study, could you get it for me?", "fetch(phone)"),
        ("-", "My keys are gone. I think they are on the desk. Could you fetch them?", "fetch(keys)"),
        ("busy:find my purse", "It's alright, it was in my coat all along!", "stop()"),
        ("-", "Bring me the sponge on the counter in the kitchen.", "goto(counter); fetch(sponge)"),
        (
            "-",
            "I hung the pictures in the bedroom, but the spirit level is still on the floor there. Put it on the desk.",
            "put(spirit level, desk)",
        ),
        ("-", "We're off soon. Get me the sponge, it's on the counter in the kitchen.", "goto(counter); fetch(sponge)"),
        ("-", "Nip over to the study and see if there's a torch on the desk.", "goto(desk); answer(no)"),
        ("-", "Please don't call it the vitamin box any longer.", "forget(vitamin box)"),
        ("busy:go to the bedroom", "Could you wait a second, please?", "stop()"),
        # Speech, how it is to be spoken, and to whom.
        ("-", "Say, nice and loud, that dinner is ready.", "say(dinner is ready)"),
        ("-", "Go to the study and say, quote, the boss is here, unquote.", "goto(study); say(the boss is here)"),
        ("-", "Go to the bedroom and say: Gran, your tea is ready.", "goto(bedroom); say(gran your tea is ready)"),
        ("-", "Say buonasera to my friends.", "say(buonasera)"),
        ("-", "Wish my aunt a merry Christmas.", "say(merry christmas)"),
        # Names that come late, and what goes along with a way.
        ("-", "Fetch us the wotsit, the battery thing for the phone, the power bank.", "fetch(power bank)"),
        (
            "-",
            "Bring me the apple and, as you're in the kitchen anyway, the bowl.",
            "fetch(apple) & fetch(yellow bowl)",
        ),
        ("last:put the green can in the recycling bin", "the red one and all", "put(red can, recycling bin)"),
        ("-", "And where might a chap find a bit of soup?", "answer(dresser)"),
    ],
)
def test_the_form_is_understood(context: str, said: str, right: str) -> None:
    sentence = Sentence(context, said, right)
    found = understand(sentence)
    assert verdict(sentence, found) == "right", found
